//! The picket fence: a minimum at each spacing, on the map and in the verdict.

use crate::support::{fact, panel_of};
use crate::w16_1_basin_explorer::common::{class_at, fill, with};
use widget_kit::model::{Assessment, Model};
use widget_kit::scene::RasterCell;
use widgets::w16_1_basin_explorer::model::{BasinExplorer, panel};

#[test]
fn the_basin_map_has_a_band_at_each_spacing() {
    let mut model = with(&[("scene", 1.0), ("dy", 0.0)]);
    fill(&mut model);
    // Right, one post off and two posts off, and the same downwards.
    let bands = [(0.0, 0), (0.5, 1), (1.0, 2), (-0.5, 1), (-1.0, 2)];
    for (dx_m, class) in bands {
        let cell = class_at(&model, panel::POINT, [0.0, dx_m]);
        assert_eq!(cell, RasterCell::Class(class), "from {dx_m} m");
    }
    let legend = panel_of(&model, panel::PLANE).legend;
    let names: Vec<_> = legend.iter().map(|entry| entry.label.as_str()).collect();
    assert_eq!(
        names,
        [
            "1 one post off",
            "2 two posts off or more",
            "F another false minimum",
            "S not converged"
        ]
    );
}

#[test]
fn one_post_off_fits_as_well_as_the_truth() {
    let at = |dx: f64| with(&[("scene", 1.0), ("heading", 0.0), ("dx", dx), ("dy", 0.0)]);
    let (home, off) = (at(0.1), at(0.4));
    assert_eq!(home.outcome().verdict, "right minimum");
    assert_eq!(off.outcome().verdict, "one post off");
    assert_eq!(off.outcome().standing, Assessment::Bad);
    assert!((fact(&off, "error_m") - 0.5).abs() < 0.03);
    assert!(fact(&off, "rmse_m") < 1.5 * fact(&home, "rmse_m"));
}

#[test]
fn the_preset_sets_the_fence_and_defaults_restore_the_room() {
    let mut model = BasinExplorer::default();
    fill(&mut model);
    let room = model.summary();
    model.press("fence").unwrap();
    assert_eq!(model.outcome().verdict, "one post off");
    assert!(model.summary().contains("one row of equal posts"));
    // A map of the room is not reused for the fence.
    assert_eq!(
        class_at(&model, panel::POINT, [0.0, 0.0]),
        RasterCell::Unknown
    );
    model.press("defaults").unwrap();
    assert_eq!(model.summary(), room);
}
