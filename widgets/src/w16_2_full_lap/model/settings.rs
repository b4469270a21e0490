//! Converts the values of the parameters to the types of the core.

use ch16_lab::lap::{LapConfig, LapSettings, LoopClosure};
use ch16_slam2d::chi_squared::gate_threshold;
use widget_kit::param::ParamError;
use widget_kit::run::LOOPS;
use widget_kit::run::NOISE;
use widget_kit::values::Values;

use crate::w16_2_full_lap::spec::{
    CAP, GATE, GATE_MODEL, INFORMATION, MATCHER, MISSES, NORMALS, PARAMS, SEED, SPEC, WORLD,
};

/// Reads the values.
pub fn read(values: &Values) -> LapSettings {
    LapSettings {
        world: values.get(&WORLD),
        seed: values.get(&SEED),
        noise_factor: values.get(&NOISE),
        loop_closure: if values.get(&LOOPS) {
            LoopClosure::On
        } else {
            LoopClosure::Off
        },
        gate_chi2: gate_threshold(values.get(&GATE)),
        gate_model: values.get(&GATE_MODEL),
        matcher: values.get(&MATCHER),
        information_frame: values.get(&INFORMATION),
        normals_cells: Some(values.get(&NORMALS)).filter(|cells| *cells > 0.0),
        is_capped: values.get(&CAP),
        keeps_misses: values.get(&MISSES),
    }
}

/// The lap of a link to the widget: `seed=6&matcher=p2l`, in a built-in world.
///
/// # Errors
/// If a parameter does not exist or its value is invalid; `None` for the reader's own flat.
pub fn lap_of_link(link: &str) -> Result<Option<LapConfig>, ParamError> {
    let mut values = Values::defaults(PARAMS);
    for (id, text) in link.split('&').filter_map(|pair| pair.split_once('=')) {
        let (param, _) = values.find_for(SPEC.id, id)?;
        values.set(SPEC.id, id, param.parse(text)?)?;
    }
    Ok(read(&values).config(None))
}
