//! From recorded points to lines in pixels: gaps where nothing can be drawn, cut at the frame, thinned without losing a peak.

use super::picture::Rect;

/// The connected parts of a curve that lie in `frame`. `points` are in pixels; `None` breaks the curve.
pub(crate) fn pieces(
    points: impl Iterator<Item = Option<(f64, f64)>>,
    frame: &Rect,
) -> Vec<Vec<(f64, f64)>> {
    let mut all: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut piece: Vec<(f64, f64)> = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    for point in points {
        if let (Some(a), Some(b)) = (before, point)
            && let Some((from, to)) = cut(a, b, frame)
        {
            if piece.last() != Some(&from) {
                close(&mut all, &mut piece);
                piece.push(from);
            }
            piece.push(to);
        }
        before = point;
    }
    close(&mut all, &mut piece);
    all
}

fn close(all: &mut Vec<Vec<(f64, f64)>>, piece: &mut Vec<(f64, f64)>) {
    if piece.len() > 1 {
        all.push(thin(piece));
    }
    piece.clear();
}

/// The part of the segment from `a` to `b` that lies in the frame (Liang and Barsky's algorithm).
fn cut(a: (f64, f64), b: (f64, f64), frame: &Rect) -> Option<((f64, f64), (f64, f64))> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut enter, mut leave) = (0.0, 1.0);
    let sides = [
        (-dx, a.0 - frame.left),
        (dx, frame.right - a.0),
        (-dy, a.1 - frame.top),
        (dy, frame.bottom - a.1),
    ];
    for (towards, room) in sides {
        if towards == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if towards < 0.0 {
            enter = f64::max(enter, room / towards);
        } else {
            leave = f64::min(leave, room / towards);
        }
    }
    if enter > leave {
        return None;
    }
    let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    // The ends themselves are kept bit for bit, so that neighbouring segments join.
    Some((
        if enter > 0.0 { at(enter) } else { a },
        if leave < 1.0 { at(leave) } else { b },
    ))
}

/// Keeps of every run of points in one column of pixels the first, the lowest, the highest and the last.
fn thin(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut kept = Vec::new();
    for run in points.chunk_by(|a, b| a.0.floor() == b.0.floor()) {
        let (mut low, mut high) = (0, 0);
        for (i, point) in run.iter().enumerate() {
            if point.1 < run[low].1 {
                low = i;
            }
            if point.1 > run[high].1 {
                high = i;
            }
        }
        let mut chosen = [0, low.min(high), low.max(high), run.len() - 1].to_vec();
        chosen.dedup();
        kept.extend(chosen.into_iter().map(|i| run[i]));
    }
    kept
}

/// Length along a line.
pub(crate) fn length(points: &[(f64, f64)]) -> f64 {
    points
        .windows(2)
        .map(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1))
        .sum()
}

/// Those points of a curve that are at least `gap` pixels from the last one kept, for markers on a line.
pub(crate) fn spaced(points: Vec<(f64, f64)>, gap: f64) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for point in points {
        if kept
            .last()
            .is_none_or(|last| (point.0 - last.0).hypot(point.1 - last.1) >= gap)
        {
            kept.push(point);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect {
        left: 0.0,
        top: 0.0,
        right: 100.0,
        bottom: 50.0,
    };

    #[test]
    fn a_curve_breaks_where_a_point_is_missing() {
        let points = [
            Some((1.0, 1.0)),
            Some((9.0, 2.0)),
            None,
            Some((20.0, 3.0)),
            Some((30.0, 4.0)),
            None,
            Some((40.0, 5.0)),
        ];
        let expected = vec![vec![(1.0, 1.0), (9.0, 2.0)], vec![(20.0, 3.0), (30.0, 4.0)]];
        assert_eq!(pieces(points.into_iter(), &FRAME), expected);
    }

    #[test]
    fn a_curve_is_cut_at_the_frame() {
        let points = [
            (-10.0, 10.0),
            (10.0, 10.0),
            (10.0, 1e200),
            (20.0, 10.0),
            (20.0, 60.0),
        ]
        .map(Some);
        let pieces = pieces(points.into_iter(), &FRAME);
        assert_eq!(pieces[0], [(0.0, 10.0), (10.0, 10.0), (10.0, 50.0)]);
        assert!(
            pieces
                .iter()
                .flatten()
                .all(|p| (0.0..=100.0).contains(&p.0) && (-1e-9..=50.0 + 1e-9).contains(&p.1))
        );
    }

    #[test]
    fn thinning_keeps_peaks_and_bounds_the_number_of_points() {
        let mut points: Vec<(f64, f64)> = (0..100_000)
            .map(|i| (f64::from(i) * 1e-3, f64::from(i % 7) + 20.0))
            .collect();
        points[54_321].1 = 3.0;
        let pieces = pieces(points.into_iter().map(Some), &FRAME);
        assert!(pieces[0].len() <= 400, "{}", pieces[0].len());
        assert!(pieces[0].contains(&(54.321, 3.0)));
    }
}
