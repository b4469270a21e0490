//! The result in words and numbers.

use ch16_lab::jacobians::EDGE_STD;
use widget_kit::model::{Assessment, Fact, Outcome};

use super::{NAMES, WrongJacobians};

/// Results closer than this count as the same, m: the standard deviation of one edge.
pub const SAME_END_M: f64 = EDGE_STD.0;

/// The solver whose residual is wrong.
const RESIDUAL: usize = 3;

/// Whether a solver converges to the optimum.
pub fn ends_at_the_optimum(widget: &WrongJacobians, solver: usize) -> bool {
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
            sentence: "All four start from the same poses. Press Play, or take a step".to_owned(),
            facts: facts(widget),
        };
    }
    if !widget.is_over() {
        // The ends are the answer to the exercise beside the widget.
        return Outcome {
            standing: Assessment::Neutral,
            verdict: "on the way".to_owned(),
            sentence: format!(
                "step {} of {}. {}",
                widget.step(),
                widget.last(),
                distances(widget)
            ),
            facts: facts(widget),
        };
    }
    let good = (0..NAMES.len()).all(|solver| ends_at_the_optimum(widget, solver));
    Outcome {
        standing: if good {
            Assessment::Good
        } else {
            Assessment::Bad
        },
        verdict: verdict(widget).to_owned(),
        sentence: distances(widget),
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

/// `Off by: approximate 12 mm, … At the optimum: exact, …` at the current step.
fn distances(widget: &WrongJacobians) -> String {
    let (far, near): (Vec<_>, Vec<_>) = (0..NAMES.len())
        .map(|solver| (solver, (1e3 * widget.shown(solver).off_m).round()))
        .partition(|(_, off_mm)| *off_mm > 0.0);
    let off = far.into_iter().map(|(solver, off_mm)| {
        let is_stuck = widget.is_over() && !widget.solved.runs[solver].rests;
        let still = if is_stuck { "still " } else { "" };
        format!("{} {still}{off_mm:.0} mm", NAMES[solver])
    });
    let at = near.into_iter().map(|(solver, _)| NAMES[solver].to_owned());
    let list = |head: &str, names: Vec<String>| {
        (!names.is_empty()).then(|| format!("{head}: {}", names.join(", ")))
    };
    let sentences = [
        list("Off by", off.collect()),
        list("At the optimum", at.collect()),
    ];
    sentences
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(". ")
}

/// The picture in words.
pub fn summary(_widget: &WrongJacobians) -> String {
    "A pose graph of eight poses around a ring, solved in four ways.".to_owned()
}
