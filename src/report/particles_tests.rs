use super::*;
use crate::report::raster;

fn disc(points: usize) -> Frame {
    // Vogel's spiral: even cover of the unit disc.
    let place = |i: usize| {
        let (r, angle) = (
            ((i as f64 + 0.5) / points as f64).sqrt(),
            2.399_963 * i as f64,
        );
        [r * angle.cos(), r * angle.sin()]
    };
    let points: Vec<[f64; 2]> = (0..points).map(place).collect();
    let values = Some(points.iter().map(|p| p[0].hypot(p[1])).collect());
    Frame {
        label: "t = 1 s".into(),
        points,
        values,
    }
}

fn plot(frames: Vec<Frame>) -> ParticlePlot {
    ParticlePlot {
        value_label: "r (m)".into(),
        particle_size: 0.03,
        frames,
        ..ParticlePlot::default()
    }
}

fn color_at(picture: &Picture, (x, y): (f64, f64)) -> Color {
    let pixels = raster::pixels(picture).expect("a picture");
    let p = pixels.pixel(x as u32, y as u32).expect("inside");
    Color(p.red(), p.green(), p.blue())
}

#[test]
fn a_particle_has_the_color_of_its_value_at_its_place() {
    let points = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let frame = Frame {
        points,
        values: Some(vec![0.0, 1.0, f64::NAN, 0.5]),
        ..Frame::default()
    };
    let plot = ParticlePlot {
        particle_size: 0.2,
        bounds: Some([[-1.0, -1.0], [2.0, 2.0]]),
        ..plot(vec![frame])
    };
    let size = Size {
        width: 500,
        height: 400,
    };
    let (plan, picture) = (Plan::new(&plot, size), plot.picture(size));
    let rect = plan.frames[0];
    let at = |x: f64, y: f64| {
        let place = (
            rect.left + (x + 1.0) / 3.0 * rect.width(),
            rect.bottom - (y + 1.0) / 3.0 * rect.height(),
        );
        color_at(&picture, place)
    };
    assert_eq!(at(0.0, 0.0), ColorMap::Viridis.at(0.0));
    assert_eq!(at(1.0, 0.0), ColorMap::Viridis.at(1.0));
    assert_eq!(at(1.0, 1.0), ColorMap::Viridis.at(0.5));
    assert_eq!(at(0.0, 1.0), ColorMap::Viridis.at(f64::NAN));
    assert_eq!(at(0.5, 0.5), Color(255, 255, 255));
}

#[test]
fn both_axes_have_one_scale() {
    for (width, height) in [(900, 300), (300, 900), (600, 600)] {
        let plot = ParticlePlot {
            bounds: Some([[0.0, 0.0], [3.0, 2.0]]),
            ..plot(vec![disc(10); 3])
        };
        for rect in Plan::new(&plot, Size { width, height }).frames {
            assert!((rect.width() / 3.0 - rect.height() / 2.0).abs() < 1e-9);
            assert!(
                rect.right <= f64::from(width) && rect.bottom <= f64::from(height),
                "{rect:?}"
            );
        }
    }
}

#[test]
fn signed_values_put_zero_in_the_middle() {
    let frame = Frame {
        points: vec![[0.0; 2]; 2],
        values: Some(vec![-1.0, 3.0]),
        ..Frame::default()
    };
    let plot = ParticlePlot {
        color_map: ColorMap::BlueRed,
        ..plot(vec![frame])
    };
    assert_eq!(plot.value_axis().map(|a| a.range()), Some([-3.0, 3.0]));
}

#[test]
fn any_particles_in_any_size_give_a_picture() {
    let odd = [f64::NAN, f64::INFINITY, 1e308, -1e308, 1e-310, 0.0, 2.5];
    let points: Vec<[f64; 2]> = odd
        .iter()
        .flat_map(|&x| odd.iter().map(move |&y| [x, y]))
        .collect();
    let frames = [
        vec![],
        vec![Frame::default()],
        vec![Frame {
            points: vec![[1.0, 2.0]],
            values: Some(vec![]),
            ..Frame::default()
        }],
        vec![
            Frame {
                points: points.clone(),
                values: Some(vec![f64::NAN; 3]),
                ..Frame::default()
            };
            5
        ],
        vec![Frame {
            points,
            values: Some(odd.to_vec()),
            ..Frame::default()
        }],
        vec![disc(50); 30],
    ];
    for frames in frames {
        for particle_size in [0.0, -1.0, 0.1, 1e300, f64::NAN] {
            for cell_size in [None, Some(0.0), Some(0.1), Some(1e-30), Some(f64::NAN)] {
                let plot = ParticlePlot {
                    particle_size,
                    cell_size,
                    ..plot(frames.clone())
                };
                for (width, height) in [(1, 1), (200, 20), (120, 90)] {
                    let picture = plot.picture(Size { width, height });
                    picture.png().expect("a PNG");
                    let svg = picture.svg().expect("an SVG");
                    assert!(!svg.contains("NaN") && !svg.contains("inf"));
                }
                assert!(plot.fitting_size().height <= WIDTH);
            }
        }
    }
}

#[test]
fn the_same_particles_give_the_same_bytes() {
    let plot = plot(vec![disc(2000); 2]);
    let bytes = || plot.picture(plot.fitting_size()).png().expect("a PNG");
    assert_eq!(bytes(), bytes());
}
