//! All widgets, in the order of the chapter.

use widget_kit::model::Model;
#[cfg(feature = "view")]
use widget_kit::shell::Shell;
use widget_kit::spec::WidgetSpec;

macro_rules! widgets {
    ($($module:ident: $model:ident;)*) => {
        /// The constant descriptions of all widgets. A program that uses only this list does not link the
        /// estimator.
        pub const SPECS: [&WidgetSpec; [$(stringify!($module)),*].len()] =
            [$(&crate::$module::spec::SPEC),*];

        /// Constructors of the models, in the order of [`SPECS`].
        pub const MODELS: [fn() -> Box<dyn Model>; SPECS.len()] =
            [$(|| Box::new(crate::$module::model::$model::default())),*];

        /// Constructors of the widgets, ready to draw, in the order of [`SPECS`].
        #[cfg(feature = "view")]
        pub const SHELLS: [fn() -> Shell; SPECS.len()] = [$(|| {
            let model = crate::$module::model::$model::default();
            Shell::new(Box::new(model), crate::$module::view::arrange)
        }),*];
    };
}

widgets! {
    w16_1_basin_explorer: BasinExplorer;
    w16_2_full_lap: FullLap;
    w16_3_cost_terraces: CostTerraces;
    w16_4_control_room: ControlRoom;
    w16_5_pose_graph_toy: PoseGraphToy;
    w16_6_whole_window: WholeWindow;
    w16_7_place_recognition: PlaceRecognition;
    w16_8_moving_box: MovingBox;
    w16_9_relocalization: Relocalization;
    w16_10_own_robot: OwnRobot;
    w16_11_procrustes: ProcrustesTrace;
    w16_12_jacobians: WrongJacobians;
}

/// The description of the widget of that name, such as `w16.1`.
#[must_use]
pub fn spec(name: &str) -> Option<&'static WidgetSpec> {
    SPECS.into_iter().find(|spec| spec.id == name)
}

/// The constructor of the widget of that name, ready to draw.
///
/// # Errors
/// A sentence that lists the names, if no widget has this one.
#[cfg(feature = "view")]
pub fn find(name: &str) -> Result<fn() -> Shell, String> {
    let index = SPECS.iter().position(|spec| spec.id == name);
    index
        .map(|index| SHELLS[index])
        .ok_or_else(|| unknown(name))
}

/// The names, for messages: `w16.1, w16.2, …`.
#[must_use]
pub fn names() -> String {
    SPECS.map(|spec| spec.id).join(", ")
}

/// The error message for an unknown name.
#[must_use]
pub fn unknown(name: &str) -> String {
    format!("there is no widget `{name}`; there are {}", names())
}
