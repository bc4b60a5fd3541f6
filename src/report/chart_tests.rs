use super::*;
use crate::report::raster;

const SIZE: Size = Size {
    width: 640,
    height: 400,
};

/// How many pixels of a picture have exactly this color.
fn count(picture: &Picture, color: Color) -> usize {
    let pixels = raster::pixels(picture).expect("a picture");
    pixels
        .pixels()
        .iter()
        .filter(|p| Color(p.red(), p.green(), p.blue()) == color)
        .count()
}

fn chart(series: Vec<Series>) -> LineChart {
    LineChart {
        title: "T".into(),
        x_label: "x".into(),
        y_label: "y".into(),
        series,
        ..LineChart::default()
    }
}

fn wave(scale: f64) -> Vec<(f64, f64)> {
    (0..=400)
        .map(|i| f64::from(i) / 40.0)
        .map(|t| (t, scale * t.cos()))
        .collect()
}

#[test]
fn a_point_is_drawn_where_its_value_says() {
    // In a frame of x and y from 0 to 4, the dot at (1, 3) is a quarter from the left and from the top.
    let mut chart = chart(vec![Series::new("", vec![(1.0, 3.0)], Style::Markers)]);
    chart.x_range = Some([0.0, 4.0]);
    chart.y_range = Some([0.0, 4.0]);
    let picture = picture(&[chart], SIZE);
    let corner = picture.shapes.iter().find_map(|s| match s {
        Shape::Line { points, .. } if points.len() == 3 => Some(points.clone()),
        _ => None,
    });
    let corner = corner.expect("the axes are one line of three points");
    let (top, bottom, right) = (corner[0], corner[1], corner[2]);
    let x = bottom.0 + 0.25 * (right.0 - bottom.0);
    let y = top.1 + 0.25 * (bottom.1 - top.1);
    let pixels = raster::pixels(&picture).expect("a picture");
    let at = |x: f64, y: f64| {
        pixels
            .pixel(x as u32, y as u32)
            .map(|p| Color(p.red(), p.green(), p.blue()))
    };
    assert_eq!(at(x, y), Some(PALETTE[0]));
    assert_ne!(at(x + 12.0, y), Some(PALETTE[0]));
    let drawn = count(&picture, PALETTE[0]);
    assert!((10..80).contains(&drawn), "one dot and no legend: {drawn}");
}

#[test]
fn an_exact_curve_and_a_computed_one_are_both_seen_where_they_coincide() {
    for style in [Style::Line, Style::Markers, Style::LineMarkers] {
        let both = chart(vec![
            Series::new(
                "computed",
                wave(1.0).into_iter().step_by(20).collect(),
                style,
            ),
            Series::new("exact", wave(1.0), Style::Dashed),
        ]);
        let nearly = |picture: &Picture, color: Color| {
            let pixels = raster::pixels(picture).expect("a picture");
            let near = |a: u8, b: u8| a.abs_diff(b) < 40;
            let same = |p: &&tiny_skia::PremultipliedColorU8| {
                near(p.red(), color.0) && near(p.green(), color.1) && near(p.blue(), color.2)
            };
            pixels.pixels().iter().filter(same).count()
        };
        let picture = picture(std::slice::from_ref(&both), SIZE);
        let mut without = both.clone();
        without.series[1].points.clear();
        let mut alone = both;
        alone.series[0].points.clear();
        let dark =
            nearly(&picture, INK) as f64 - nearly(&super::picture(&[without], SIZE), INK) as f64;
        let blue = nearly(&picture, PALETTE[0]) as f64
            - nearly(&super::picture(&[alone], SIZE), PALETTE[0]) as f64;
        assert!(
            dark > 100.0 && blue > 100.0,
            "{style:?}: {dark} dark, {blue} blue"
        );
    }
}

#[test]
fn a_png_has_the_size_that_was_asked_for_and_the_same_bytes_again() {
    let charts = vec![chart(vec![Series::new("a", wave(1e-7), Style::LineMarkers)]); 3];
    let bytes = picture(&charts, SIZE).png().expect("a PNG");
    assert_eq!(bytes, picture(&charts, SIZE).png().expect("a PNG"));
    let decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
    let mut reader = decoder.read_info().expect("a header");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("pixels");
    assert_eq!((info.width, info.height), (SIZE.width, SIZE.height));
    assert!(
        pixels
            .chunks_exact(3)
            .any(|p| p == [PALETTE[0].0, PALETTE[0].1, PALETTE[0].2])
    );
    assert_eq!(
        picture(&charts, SIZE).svg().expect("an SVG"),
        picture(&charts, SIZE).svg().expect("an SVG")
    );
}

#[test]
fn any_numbers_in_any_size_give_a_picture() {
    let extremes = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        1e-310,
        1e-7,
        1e300,
        1e308,
        -1e308,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
    ];
    let all: Vec<(f64, f64)> = extremes
        .iter()
        .flat_map(|&x| extremes.iter().map(move |&y| (x, y)))
        .collect();
    let mut sets = vec![
        vec![],
        vec![(0.0, 0.0)],
        vec![(1.0, 5.0); 9],
        vec![(0.0, 1.0), (1.0, 1.0 + 1e-15)],
        all,
    ];
    sets.extend(extremes.iter().map(|&v| vec![(v, v)]));
    for points in sets {
        for logs in 0..4 {
            let styles = [
                Style::Line,
                Style::Dashed,
                Style::Markers,
                Style::LineMarkers,
            ];
            let mut chart = chart(
                styles
                    .map(|style| Series::new("s", points.clone(), style))
                    .to_vec(),
            );
            (chart.x_log, chart.y_log) = (logs & 1 == 1, logs & 2 == 2);
            for (width, height) in [(160, 100), (1, 1), (3, 400), (400, 3)] {
                let picture = picture(std::slice::from_ref(&chart), Size { width, height });
                picture.png().expect("a PNG");
                let svg = picture.svg().expect("an SVG");
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{points:?}");
            }
        }
    }
    picture(&[], SIZE).png().expect("an empty picture");
    assert!(
        picture(
            &[],
            Size {
                width: 0,
                height: 10
            }
        )
        .png()
        .is_err()
    );
    assert!(
        picture(
            &[],
            Size {
                width: 10,
                height: 4_000_000_000
            }
        )
        .svg()
        .is_err()
    );
}

#[test]
fn many_points_stay_few_in_the_file() {
    let points: Vec<(f64, f64)> = (0..100_000)
        .map(|i| (f64::from(i), (f64::from(i) * 0.37).sin()))
        .collect();
    let svg = picture(&[chart(vec![Series::new("a", points, Style::Line)])], SIZE)
        .svg()
        .expect("an SVG");
    assert!(svg.len() < 60_000, "{} bytes", svg.len());
}

#[test]
fn a_long_legend_stays_inside_the_picture_and_above_the_frame() {
    let names = (0..14).map(|i| {
        Series::new(
            format!("method number {i}"),
            wave(f64::from(i)),
            Style::Line,
        )
    });
    let picture = picture(&[chart(names.collect())], SIZE);
    let frame_top = picture.shapes.iter().find_map(|s| match s {
        Shape::Line { points, .. } if points.len() == 3 => Some(points[0].1),
        _ => None,
    });
    let mut names = 0;
    for shape in &picture.shapes {
        if let Shape::Text {
            x, y, text, size, ..
        } = shape
            && text.starts_with("method")
        {
            names += 1;
            assert!(
                x + font::width(text, *size) <= 640.0 && Some(*y) < frame_top,
                "{text} at {x}, {y}"
            );
        }
    }
    assert_eq!(names, 14);
}

#[test]
fn panels_stand_in_a_grid_that_suits_the_picture() {
    assert_eq!(columns(1, SIZE), 1);
    assert_eq!(
        columns(
            2,
            Size {
                width: 800,
                height: 1000
            }
        ),
        1
    );
    assert_eq!(
        columns(
            2,
            Size {
                width: 1600,
                height: 500
            }
        ),
        2
    );
    assert_eq!(
        columns(
            4,
            Size {
                width: 1600,
                height: 1000
            }
        ),
        2
    );
    assert_eq!(
        columns(
            0,
            Size {
                width: 0,
                height: 0
            }
        ),
        1
    );
}

#[test]
fn a_file_with_an_unknown_ending_is_refused_with_its_name() {
    let error = chart(vec![])
        .write(Path::new("/tmp/picture.bmp"))
        .expect_err("no BMP");
    assert!(
        error.to_string().contains("/tmp/picture.bmp")
            && error.to_string().contains(".png or .svg")
    );
    let error = chart(vec![])
        .write(Path::new("/no/such/folder/p.png"))
        .expect_err("no folder");
    assert!(
        error.to_string().contains("/no/such/folder/p.png"),
        "{error}"
    );
}
