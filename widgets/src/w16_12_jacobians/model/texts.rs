//! The result in words and numbers.

use ch16_lab::jacobians::EDGE_STD;
use widget_kit::model::{Assessment, Fact, Outcome};

use super::{NAMES, WrongJacobians};

/// Results closer than this count as the same, m: the standard deviation of one edge.
pub const SAME_END_M: f64 = EDGE_STD.0;

/// The solver whose residual is wrong.
const RESIDUAL: usize = 3;

fn ends_at_the_optimum(widget: &WrongJacobians, solver: usize) -> bool {
    let run = &widget.solved.runs[solver];
    run.rests && run.end().off_m < SAME_END_M
}

/// Good is convergence to the optimum.
pub fn standing_of(widget: &WrongJacobians, solver: usize) -> Assessment {
    if ends_at_the_optimum(widget, solver) {
        Assessment::Good
    } else {
        Assessment::Bad
    }
}

fn verdict(widget: &WrongJacobians) -> &'static str {
    let runs = &widget.solved.runs;
    let at_home = |solver| ends_at_the_optimum(widget, solver);
    if runs.iter().any(|run| !run.rests) {
        "not all converge"
    } else if (0..RESIDUAL).all(at_home) {
        if at_home(RESIDUAL) {
            "all four end alike"
        } else {
            "the wrong residual ends elsewhere"
        }
    } else {
        "a Jacobian ends elsewhere"
    }
}

pub fn outcome(widget: &WrongJacobians) -> Outcome {
    if widget.step() == 0 {
        return Outcome {
            standing: Assessment::Neutral,
            verdict: "before the first step".to_owned(),
            sentence: "All four start from the same poses: play, or make a step".to_owned(),
            facts: facts(widget),
        };
    }
    if !widget.is_over() {
        // The ends are the answer to the exercise beside the widget.
        return Outcome {
            standing: Assessment::Neutral,
            verdict: "on the way".to_owned(),
            sentence: format!(
                "step {} of {}: {}",
                widget.step(),
                widget.last(),
                now(widget)
            ),
            facts: facts(widget),
        };
    }
    let parts = widget.solved.runs.iter().zip(NAMES).map(|(run, name)| {
        let still = if run.rests { "" } else { "still " };
        format!("{name} {still}{:.3} m", run.end().off_m)
    });
    let parts: Vec<_> = parts.collect();
    let good = (0..NAMES.len()).all(|solver| ends_at_the_optimum(widget, solver));
    Outcome {
        standing: if good {
            Assessment::Good
        } else {
            Assessment::Bad
        },
        verdict: verdict(widget).to_owned(),
        sentence: format!("off the optimum at the end: {}", parts.join(", ")),
        facts: facts(widget),
    }
}

/// The four results at the current step; at the last one they are the ends.
fn facts(widget: &WrongJacobians) -> Vec<Fact> {
    let ids = [
        ["exact_steps", "exact_off_m", "exact_chi2"],
        ["approximate_steps", "approximate_off_m", "approximate_chi2"],
        ["jacobian_steps", "jacobian_off_m", "jacobian_chi2"],
        ["residual_steps", "residual_off_m", "residual_chi2"],
    ];
    let labels = [
        ["exact: steps", "exact: off by", "exact: χ²"],
        [
            "approximate: steps",
            "approximate: off by",
            "approximate: χ²",
        ],
        [
            "wrong Jacobian: steps",
            "wrong Jacobian: off by",
            "wrong Jacobian: χ²",
        ],
        [
            "wrong residual: steps",
            "wrong residual: off by",
            "wrong residual: χ²",
        ],
    ];
    let names = ids.into_iter().zip(labels).enumerate();
    names
        .flat_map(
            |(solver, ([steps_id, off_id, chi2_id], [steps, off, chi2]))| {
                let shown = widget.shown(solver);
                [
                    Fact::count(steps_id, steps, widget.steps_of(solver) as f64),
                    Fact::new(off_id, off, shown.off_m, "m", 4),
                    Fact::new(chi2_id, chi2, shown.chi2, "", 2),
                ]
            },
        )
        .collect()
}

/// `exact 0.000 m off, approximate 0.012 m off, …` at the current step.
fn now(widget: &WrongJacobians) -> String {
    let each = NAMES.iter().enumerate();
    let distances =
        each.map(|(solver, name)| format!("{name} {:.3} m off", widget.shown(solver).off_m));
    distances.collect::<Vec<_>>().join(", ")
}

pub fn summary(widget: &WrongJacobians) -> String {
    let setting = "A pose graph of eight poses around a ring, solved in four ways";
    format!("{setting}. {}.", outcome(widget).sentence)
}
