//! The four solvers without their picture.

use widget_kit::invariants::assert_reports;
use widget_kit::model::{Activity, Assessment, Model};
use widget_kit::scene::Layer;
use widgets::w16_12_jacobians::model::{WrongJacobians, panel};
use widgets::w16_12_jacobians::spec::{LEAST_BIAS_DEG, MAX_STEPS, SPEC};

use crate::support::fact;

/// At its last step, unless the values name another.
fn with(values: &[(&str, f64)]) -> WrongJacobians {
    let mut widget = WrongJacobians::default();
    widget.set("steps", MAX_STEPS as f64).unwrap();
    for (id, value) in values {
        widget.set(id, *value).unwrap();
    }
    widget
}

#[test]
fn the_wrong_residual_alone_ends_elsewhere_and_the_wrong_jacobian_takes_more_steps() {
    for wrong in [0.0, 1.0] {
        let widget = with(&[("wrong", wrong)]);
        assert_eq!(
            widget.outcome().verdict,
            "the wrong residual ends elsewhere"
        );
        assert_eq!(widget.outcome().standing, Assessment::Bad);
        for id in ["approximate_steps", "jacobian_steps"] {
            assert!(fact(&widget, id) > fact(&widget, "exact_steps"), "{id}");
        }
        assert!(fact(&widget, "residual_off_m") > 10.0 * fact(&widget, "approximate_off_m"));
        assert!(fact(&widget, "residual_chi2") > fact(&widget, "exact_chi2"));
    }
}

#[test]
fn half_the_contradiction_halves_one_error_and_quarters_the_other() {
    let [whole, half] = [6.0, 3.0].map(|bias| with(&[("bias", bias)]));
    let share = |id: &str| fact(&half, id) / fact(&whole, id);
    // A tenth of each: the next order of the expansion.
    assert!((share("residual_off_m") - 0.5).abs() < 0.05);
    assert!((share("approximate_off_m") - 0.25).abs() < 0.025);
}

#[test]
fn each_curve_ends_at_the_value_of_the_table() {
    let widget = with(&[]);
    let panels = widget.scene().panels;
    let curve = panels
        .iter()
        .find(|panel| panel.id == panel::CURVE)
        .unwrap();
    let ends = curve.layers.iter().filter_map(|layer| match layer {
        Layer::Points { points, .. } => points.last(),
        _ => None,
    });
    let ends: Vec<_> = ends.collect();
    assert_eq!(ends.len(), 4);
    let ids = ["exact", "approximate", "jacobian", "residual"];
    for (end, id) in ends.iter().zip(ids) {
        assert_eq!(end[0], fact(&widget, &format!("{id}_steps")));
        let off_m = fact(&widget, &format!("{id}_off_m"));
        // The tenth line is a metre, each below it a tenth, and the first is the lower end.
        let line = off_m.max(1e-9).log10() + 10.0;
        assert!((end[1] - line).abs() < 1e-9, "{id}");
    }
    let by_chi2 = with(&[("curve", 1.0)]).scene().panels;
    assert_eq!(by_chi2.last().unwrap().title, "χ² above the optimum");
}

#[test]
fn the_step_is_dragged_along_the_curves() {
    let mut widget = with(&[("steps", 3.0)]);
    let handle = widget.grab(panel::CURVE, [3.2, 0.0], [0.5, 1.0]).unwrap();
    widget.drag(handle, [7.1, 0.0]);
    assert_eq!(widget.values().number("steps"), 7.0);
    widget.drag(handle, [f64::NAN, 0.0]);
    widget.drag(handle, [1e300, 0.0]);
    assert_eq!(
        widget.values().number("steps"),
        widget.timeline().unwrap().last
    );
    assert!(widget.grab(panel::GRAPHS, [3.0, 0.0], [9.0, 9.0]).is_none());
}

#[test]
fn every_preset_does_what_its_button_claims() {
    let after = |id: &str| {
        let mut widget = WrongJacobians::default();
        widget.press(id).unwrap();
        while widget.advance(0.2) == Activity::Busy {}
        widget
    };
    assert_eq!(
        after("four").outcome().verdict,
        "the wrong residual ends elsewhere"
    );
    let left = fact(&after("left"), "jacobian_off_m");
    assert!(
        left > 0.0005 && left < 0.0025,
        "a millimetre or two: {left}"
    );
    let half = after("half");
    assert!(fact(&half, "residual_off_m") < 0.6 * fact(&after("four"), "residual_off_m"));
    let last = after("four").timeline().unwrap().last;
    assert!(last > 20.0 && last <= MAX_STEPS as f64);
    assert_eq!(SPEC.presets.len(), 3, "a preset without a test");
}

#[test]
fn all_settings_converge() {
    for bias in [LEAST_BIAS_DEG, 6.0, 10.0] {
        for scatter in [0.0, 0.3] {
            for (wrong, seed) in [(0.0, 1.0), (1.0, 2.0), (0.0, 4_294_967_295.0)] {
                let values = [
                    ("bias", bias),
                    ("scatter", scatter),
                    ("wrong", wrong),
                    ("seed", seed),
                ];
                let widget = with(&values);
                assert_ne!(widget.outcome().verdict, "not all converge", "{values:?}");
                assert_reports(&widget);
            }
        }
    }
}

#[test]
fn before_the_first_step_neither_picture_nor_words_tell_the_end() {
    let widget = WrongJacobians::default();
    assert_eq!(widget.outcome().verdict, "before the first step");
    assert!(!widget.outcome().sentence.contains("residual"));
    for panel in widget.scene().panels {
        assert!(!panel.title.contains("0."), "{}", panel.title);
        let of_solvers = |layer: &&Layer| {
            matches!(
                layer,
                Layer::Points {
                    tone: widget_kit::scene::Tone::Series(_),
                    ..
                }
            )
        };
        let points: Vec<_> = panel.layers.iter().filter(of_solvers).collect();
        if panel.id == "graphs" {
            assert!(points.is_empty(), "one start, not four over each other");
            continue;
        }
        let Layer::Points { points: first, .. } = points[0] else {
            unreachable!("only points were kept")
        };
        for layer in points {
            let Layer::Points { points, .. } = layer else {
                unreachable!("only points were kept")
            };
            assert_eq!(points, first, "{}: all four look alike", panel.id);
        }
    }
}

#[test]
fn on_the_way_neither_words_nor_numbers_nor_table_tell_the_end() {
    let last = WrongJacobians::default().timeline().unwrap().last;
    let before = with(&[("steps", last - 1.0)]);
    assert_eq!(before.outcome().verdict, "on the way");
    let widget = with(&[("steps", 1.0)]);
    let end = with(&[]);
    for id in ["exact_off_m", "jacobian_off_m", "residual_off_m"] {
        assert!(fact(&widget, id) > fact(&end, id), "{id}");
    }
    assert_eq!(fact(&widget, "jacobian_steps"), 1.0);
    assert!(!widget.summary().contains("end"), "{}", widget.summary());
    assert_eq!(widget.tables()[0].title, "The four after 1 step");
}

#[test]
fn the_chain_is_bent_by_its_loose_end_and_no_mark_is_ahead_of_the_step() {
    let mut widget = WrongJacobians::default();
    assert!(
        widget.timeline().unwrap().marks.is_empty(),
        "a mark gives the answer away"
    );
    let end = |widget: &WrongJacobians| {
        let layers = widget.scene().panels[0].layers.clone();
        let handle = layers.iter().find_map(|layer| match layer {
            widget_kit::scene::Layer::Handle { at, .. } => Some(*at),
            _ => None,
        });
        handle.expect("a handle at the loose end")
    };
    let wanted = {
        let mut other = WrongJacobians::default();
        other.set("bias", 2.5).unwrap();
        end(&other)
    };
    let at = end(&widget);
    let held = widget.grab("graphs", at, [0.1; 2]).expect("the loose end");
    widget.drag(held, wanted);
    assert_eq!(widget.values().number("bias"), 2.5);
    assert_eq!(end(&widget), wanted);
    // No drag takes the contradiction away, and with it what there is to see.
    let [least, more] = [LEAST_BIAS_DEG, 2.5].map(|bias| {
        let mut other = WrongJacobians::default();
        other.set("bias", bias).unwrap();
        end(&other)
    });
    let beyond = [0, 1].map(|i| 2.0 * least[i] - more[i]);
    widget.drag(held, beyond);
    assert_eq!(widget.values().number("bias"), LEAST_BIAS_DEG);
    widget.drag(held, wanted);
    widget.set("steps", 5.0).unwrap();
    assert!(widget.grab("graphs", wanted, [0.1; 2]).is_none());
}

#[test]
fn solvers_that_cannot_be_told_apart_are_one_chain() {
    let chains = |steps: f64| {
        let layers = with(&[("steps", steps)]).scene().panels[0].layers.clone();
        let of_solvers = layers.iter().filter(|layer| {
            matches!(
                layer,
                Layer::Line {
                    tone: widget_kit::scene::Tone::Series(_),
                    ..
                }
            )
        });
        of_solvers.count()
    };
    assert_eq!(
        chains(MAX_STEPS as f64),
        2,
        "three end alike, one elsewhere"
    );
    assert!(chains(1.0) > 2, "the wrong Jacobian is behind");
}
