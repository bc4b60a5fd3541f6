//! Axes: what range they show, where a value lies, which ticks they carry and how these read.

/// Magnitudes beyond which quotients of plotted numbers, with margins, would leave the floating-point range.
const LARGEST: f64 = 1e140;
/// A spread below this share of the values is round-off and drawn as a constant.
const ROUND_OFF: f64 = 1e-12;

/// The range of values along one side of a chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    log: bool,
    low: f64,
    high: f64,
}

/// A mark at an axis; one without a label is drawn smaller.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub value: f64,
    pub label: String,
}

/// The marks of one axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Ticks {
    pub marks: Vec<Tick>,
    /// What the labels are to be multiplied by and added to, if not 1 and 0.
    pub note: String,
}

impl Axis {
    /// An axis over `range`, or over all `values` that can be drawn, widened by the share `pad` of it on either side.
    pub(crate) fn new(
        log: bool,
        range: Option<[f64; 2]>,
        values: impl Iterator<Item = f64>,
        pad: f64,
    ) -> Self {
        let drawable = |v: &f64| v.abs() <= LARGEST && (!log || *v >= 1.0 / LARGEST);
        if let Some([low, high]) = range
            && low < high
            && drawable(&low)
            && drawable(&high)
        {
            return Self { log, low, high };
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in values.filter(drawable) {
            let v = if v.abs() < 1.0 / LARGEST { 0.0 } else { v };
            (low, high) = (low.min(v), high.max(v));
        }
        if low > high {
            let low = if log { 1.0 } else { 0.0 };
            return Self {
                log,
                low,
                high: low * 9.0 + 1.0,
            };
        }
        if log {
            let pad = if high / low < 1.0 + ROUND_OFF {
                3.0
            } else {
                (high / low).powf(pad)
            };
            return Self {
                log,
                low: low / pad,
                high: high * pad,
            };
        }
        let largest = low.abs().max(high.abs());
        let pad = if high - low > ROUND_OFF * largest {
            pad * (high - low)
        } else if largest > 0.0 {
            0.1 * largest
        } else {
            1.0
        };
        Self {
            log,
            low: low - pad,
            high: high + pad,
        }
    }

    /// Where a value lies between the ends: 0 at the low one, 1 at the high one. `None` if it cannot be drawn.
    pub(crate) fn share(&self, value: f64) -> Option<f64> {
        let share = if self.log {
            (value / self.low).log10() / (self.high / self.low).log10()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        (share.abs() < 1e100).then_some(share) // farther away, pixels would overflow
    }

    /// The ends.
    pub(crate) fn range(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Round numbers on the axis, about `wanted` of them.
    pub(crate) fn ticks(&self, wanted: usize) -> Ticks {
        let wanted = wanted.max(2);
        if self.log {
            self.log_ticks(wanted)
        } else {
            self.linear_ticks(wanted)
        }
    }

    fn linear_ticks(&self, wanted: usize) -> Ticks {
        let span = self.high - self.low;
        let (digit, power) = round_step(span / wanted as f64);
        let largest = self.low.abs().max(self.high.abs());
        // Values that differ only after many digits are counted from a round number near them.
        let base = if largest > 1e5 * span {
            let unit = 10f64.powi(span.log10().ceil() as i32);
            (0.5 * (self.low + self.high) / unit).round() * unit
        } else {
            0.0
        };
        let step = digit * 10f64.powi(power);
        let first = ((self.low - base) / step - 1e-6).ceil() as i64;
        let last = ((self.high - base) / step + 1e-6).floor() as i64;
        let farthest = step * first.unsigned_abs().max(last.unsigned_abs()) as f64;
        let magnitude = power_of(farthest.max(step));
        let factor = if (-3..5).contains(&magnitude) {
            0
        } else {
            magnitude
        };
        let decimals = (factor - power).max(0) as usize;
        let marks = (first..=last).map(|i| {
            let label = i as f64 * digit * 10f64.powi(power - factor);
            Tick {
                value: base + i as f64 * step,
                label: fixed(label, decimals),
            }
        });
        let mut note = if factor == 0 {
            String::new()
        } else {
            format!("×10{}", superscript(factor))
        };
        if base != 0.0 {
            let unit = span.log10().ceil() as i32;
            let digits = fixed(base.abs(), (-unit).max(0) as usize);
            let digits = if digits.contains('.') {
                digits.trim_end_matches('0').trim_end_matches('.')
            } else {
                &digits
            };
            let sign = if base < 0.0 { '−' } else { '+' };
            note = format!("{note} {sign} {digits}").trim_start().to_owned();
        }
        Ticks {
            marks: marks.collect(),
            note,
        }
    }

    fn log_ticks(&self, wanted: usize) -> Ticks {
        let (low, high) = (self.low.log10(), self.high.log10());
        let (first, last) = ((low - 1e-9).ceil() as i32, (high + 1e-9).floor() as i32);
        if last <= first && self.high / self.low < 4.0 {
            return self.linear_ticks(wanted);
        }
        let every = if last > first {
            ((last - first) as usize / wanted + 1) as i32
        } else {
            1
        };
        let mut marks = Vec::new();
        for power in (first - 1)..=last {
            for digit in 1..10 {
                let value = f64::from(digit) * 10f64.powi(power);
                let inside = self
                    .share(value)
                    .is_some_and(|s| (-1e-9..=1.0 + 1e-9).contains(&s));
                let labelled = if last > first {
                    digit == 1 && (power - first) % every == 0
                } else {
                    matches!(digit, 1 | 2 | 5)
                };
                if inside && (labelled || every == 1) {
                    let label = if !labelled {
                        String::new()
                    } else if first >= -2 && last <= 4 {
                        fixed(value, (-power).max(0) as usize)
                    } else if digit == 1 {
                        format!("10{}", superscript(power))
                    } else {
                        format!("{digit}×10{}", superscript(power))
                    };
                    marks.push(Tick { value, label });
                }
            }
        }
        Ticks {
            marks,
            note: String::new(),
        }
    }
}

/// The power of ten of the first digit of a positive number.
fn power_of(value: f64) -> i32 {
    (value.log10() + 1e-9).floor() as i32
}

/// The 1, 2 or 5 times a power of ten that is nearest by ratio, as digit and power.
fn round_step(wanted: f64) -> (f64, i32) {
    let power = power_of(wanted);
    match wanted / 10f64.powi(power) {
        x if x < 1.5 => (1.0, power),
        x if x < 3.2 => (2.0, power),
        x if x < 7.1 => (5.0, power),
        _ => (1.0, power + 1),
    }
}

fn fixed(value: f64, decimals: usize) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.decimals$}").replace('-', "−")
    }
}

/// −7 as "⁻⁷".
fn superscript(power: i32) -> String {
    let raise = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => c
            .to_digit(10)
            .and_then(|d| char::from_u32(0x2070 + d))
            .unwrap_or(c),
    };
    power.to_string().chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(log: bool, values: &[f64]) -> Axis {
        Axis::new(log, None, values.iter().copied(), 0.0)
    }

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks
            .marks
            .iter()
            .map(|t| t.label.as_str())
            .filter(|l| !l.is_empty())
            .collect()
    }

    #[test]
    fn a_log_axis_gives_every_decade_the_same_room() {
        let axis = axis(true, &[1e-9, 1e3]);
        for power in -9..3 {
            let room =
                axis.share(10f64.powi(power + 1)).unwrap() - axis.share(10f64.powi(power)).unwrap();
            assert!((room - 1.0 / 12.0).abs() < 1e-12, "{power}: {room}");
        }
        assert_eq!(axis.share(0.0), None);
        assert_eq!(axis.share(-1.0), None);
    }

    #[test]
    fn labels_are_round_and_say_the_power_of_ten_apart() {
        let ticks = axis(false, &[0.0, 100.0]).ticks(5);
        assert_eq!(labels(&ticks), ["0", "20", "40", "60", "80", "100"]);
        let ticks = axis(false, &[-1e-7, 1e-7]).ticks(4);
        assert_eq!(
            (labels(&ticks), ticks.note.as_str()),
            (vec!["−1.0", "−0.5", "0", "0.5", "1.0"], "×10⁻⁷")
        );
        let ticks = axis(false, &[0.0, 3e9]).ticks(3);
        assert_eq!(
            (labels(&ticks), ticks.note.as_str()),
            (vec!["0", "1", "2", "3"], "×10⁹")
        );
    }

    #[test]
    fn values_that_differ_in_late_digits_are_counted_from_a_base() {
        let ticks = axis(false, &[1.25, 1.25 + 4e-9]).ticks(4);
        assert_eq!(
            (labels(&ticks), ticks.note.as_str()),
            (vec!["0", "1", "2", "3", "4"], "×10⁻⁹ + 1.25")
        );
    }

    #[test]
    fn decades_and_parts_of_a_decade_are_labelled() {
        assert_eq!(
            labels(&axis(true, &[1e-6, 1e-3]).ticks(6)),
            ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³"]
        );
        assert_eq!(
            labels(&axis(true, &[0.1, 100.0]).ticks(6)),
            ["0.1", "1", "10", "100"]
        );
        assert_eq!(
            labels(&axis(true, &[1.5e-7, 8e-7]).ticks(6)),
            ["2×10⁻⁷", "5×10⁻⁷"]
        );
        assert!(labels(&axis(true, &[1e-130, 1e130]).ticks(6)).len() <= 8);
    }

    #[test]
    fn every_axis_has_a_range_and_ticks_inside_it() {
        let cases: &[&[f64]] = &[
            &[],
            &[f64::NAN, f64::INFINITY],
            &[0.0],
            &[-0.0, 0.0],
            &[5.0],
            &[-3e-200],
            &[1.0, 1.0 + 1e-15],
            &[-1e308, 1e308],
            &[-1e300, 1e300],
            &[1e-310, 3e-310],
            &[1e-299, 1e-298],
            &[1e8, 1e8 + 1.0],
            &[-7.0, -2.0],
            &[1e-300, 1e300],
            &[1e-140, 1e140],
            &[1e-7, 1e140],
            &[1e139, 1e140],
        ];
        for values in cases {
            for log in [false, true] {
                let axis = Axis::new(log, None, values.iter().copied(), 0.06);
                assert!(
                    axis.low < axis.high && axis.low.is_finite() && axis.high.is_finite(),
                    "{axis:?}"
                );
                let ticks = axis.ticks(5);
                assert!((2..120).contains(&ticks.marks.len()), "{axis:?} {ticks:?}");
                for tick in &ticks.marks {
                    let share = axis.share(tick.value).expect("a tick is on its axis");
                    assert!((-1e-3..=1.001).contains(&share), "{axis:?} {tick:?}");
                    assert!(tick.label.chars().count() < 12, "{tick:?}");
                }
            }
        }
    }
}
