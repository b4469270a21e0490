//! Random user input on every widget's model: set, press, drag, hover, play, work, in any order.

use arbitrary::{Result, Unstructured};
use widget_kit::model::{Activity, Model, Motion};
use widget_kit::scene::{Layer, Panel};

use widget_kit::invariants::{assert_reports, assert_values};
use widgets::registry::MODELS;

use crate::numbers::any;

/// Most actions of a case.
const MAX_ACTIONS: usize = 8;
/// Most work units that a case waits for at a time.
const MAX_WORK: usize = 40;

/// No action panics, every value stays in its range, and the scene has finite numbers.
pub fn fuzz(data: &[u8]) {
    let mut bytes = Unstructured::new(data);
    let Ok(maker) = bytes.choose(&MODELS) else {
        return;
    };
    let mut model = maker();
    // The case ends with its bytes.
    for _ in 0..MAX_ACTIONS {
        if act(&mut bytes, model.as_mut()).is_err() {
            break;
        }
        assert_values(model.as_ref());
    }
    assert_reports(model.as_ref());
}

fn act(bytes: &mut Unstructured<'_>, model: &mut dyn Model) -> Result<()> {
    if bytes.is_empty() {
        return Err(arbitrary::Error::NotEnoughData);
    }
    match bytes.int_in_range(0..=12)? {
        0..=3 => set(bytes, model),
        4..=5 => press(bytes, model),
        6..=7 => drag(bytes, model),
        8 => {
            let elapsed_s = *bytes.choose(&[1.0 / 60.0, 0.0, 0.5, 20.0, 1e9, 1e300])?;
            model.advance(elapsed_s);
            Ok(())
        }
        9 => {
            let most = bytes.int_in_range(1..=MAX_WORK)?;
            for _ in 0..most {
                if model.work() == Activity::Idle {
                    break;
                }
            }
            Ok(())
        }
        10 => {
            model.finish_work();
            assert!(!model.finish_work());
            Ok(())
        }
        11 => {
            let scene = model.scene();
            let panel = bytes.choose(&scene.panels)?;
            let at = point(bytes, panel)?;
            model.hover(panel.id, bytes.arbitrary::<bool>()?.then_some(at));
            Ok(())
        }
        _ => {
            let motion = *bytes.choose(&[Motion::Full, Motion::Reduced])?;
            model.set_motion(motion);
            Ok(())
        }
    }
}

fn set(bytes: &mut Unstructured<'_>, model: &mut dyn Model) -> Result<()> {
    let param = bytes.choose(model.spec().params)?;
    let (min, max) = param.range();
    let value = match bytes.int_in_range(0..=15)? {
        0 => min,
        1 => max,
        2 => any(bytes)?,
        _ => {
            let steps = ((max - min) / param.step()).min(1e9) as u32;
            min + f64::from(bytes.int_in_range(0..=steps)?) * param.step()
        }
    };
    let before = model.values().clone();
    match model.set(param.id, value) {
        Ok(()) => assert!(param.check(value).is_ok(), "{} took {value}", param.id),
        Err(_) => assert_eq!(&before, model.values(), "{} rejected {value}", param.id),
    }
    Ok(())
}

fn press(bytes: &mut Unstructured<'_>, model: &mut dyn Model) -> Result<()> {
    let spec = model.spec();
    let buttons = spec.buttons.iter().map(|button| button.id);
    let presets = spec.presets.iter().map(|preset| preset.id);
    let known: Vec<_> = buttons.chain(presets).collect();
    let button = *bytes.choose(&known)?;
    assert!(model.press(button).is_ok(), "{button}");
    Ok(())
}

fn drag(bytes: &mut Unstructured<'_>, model: &mut dyn Model) -> Result<()> {
    let scene = model.scene();
    let panel = bytes.choose(&scene.panels)?;
    let at = point(bytes, panel)?;
    let reach = [0.05, 0.05].map(|share| share * (panel.x.max - panel.x.min).abs());
    let Some(handle) = model.grab(panel.id, at, reach) else {
        model.tap(panel.id, at, reach);
        return Ok(());
    };
    assert_eq!(handle.panel, panel.id);
    for _ in 0..bytes.int_in_range(1..=3)? {
        model.drag(handle, point(bytes, panel)?);
    }
    Ok(())
}

/// A point of a panel: at a handle, somewhere on the panel, or far outside.
fn point(bytes: &mut Unstructured<'_>, panel: &Panel) -> Result<[f64; 2]> {
    match bytes.int_in_range(0..=7)? {
        0..=2 => {
            let handles = panel.layers.iter().filter_map(|layer| match layer {
                Layer::Handle { at, .. } => Some(*at),
                _ => None,
            });
            let handles: Vec<_> = handles.collect();
            Ok(*bytes.choose(&handles)?)
        }
        3 => Ok([any(bytes)?, any(bytes)?]),
        _ => {
            let bounds = panel.bounds();
            let share = |bytes: &mut Unstructured<'_>| -> Result<f64> {
                Ok(f64::from(bytes.arbitrary::<u8>()?) / 255.0)
            };
            let (x, y) = (share(bytes)?, share(bytes)?);
            let [width, height] = bounds.size();
            Ok([bounds.min[0] + x * width, bounds.min[1] + y * height])
        }
    }
}
