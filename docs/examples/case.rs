//! A block in free fall: x = x₀ − g t²/2.

use super::{Case, CaseError, Report};

/// The case.
pub const CASE: Case = Case {
    name: "falling_block",
    claim: "a block that nothing holds falls as a point does",
    reference: "closed form, x = x0 - g t^2 / 2",
    run,
};

const SCENARIO: &str = r#"
dimension = 1
gravity = [-10.0]

[time]
end = 0.2
courant = 0.2

[grid]
min = [0.0]
max = [2.0]
cell_size = 0.1

[material.soft]
density = 1000
neo_hookean = { youngs_modulus = 1e5, poissons_ratio = 0.0 }

[[body]]
name = "block"
material = "soft"
shape.box = { min = [1.0], max = [1.5] }
"#;

fn run(report: &mut Report) -> Result<(), CaseError> {
    let fall = report.run(SCENARIO, &[])?;
    let time = fall.column("body_block", "time");
    let position = fall.column("body_block", "position_x");
    let exact: Vec<f64> = time.iter().map(|t| 1.25 - 5.0 * t * t).collect();
    let error = position.iter().zip(&exact).map(|(x, e)| (x - e).abs());
    let worst = error.fold(0.0, f64::max);
    report.at_most("largest error of the position / m", worst, 2e-3);
    report.table(
        "position",
        &[("time", &time), ("computed", &position), ("exact", &exact)],
    );
    Ok(())
}
