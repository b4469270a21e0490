//! The controls that a widget shows at present; its host draws them.

use crate::model::Model;
use crate::param::{MORE, ParamKind, ParamSpec};

/// The names of the shown presets, parameters and buttons, in that order.
#[must_use]
pub fn shown(model: &dyn Model) -> Vec<&'static str> {
    let (spec, disclosure) = (model.spec(), model.disclosure());
    let timeline = model.timeline().map(|timeline| timeline.param);
    let has_param = |param: &&'static ParamSpec| match param.kind {
        ParamKind::Timeline { .. } => timeline == Some(param.id),
        // The reader draws a text, or opens it; typing is for those who know it.
        ParamKind::Text { .. } => disclosure.is_all(),
        _ => param.id == MORE.id || disclosure.has_param(param.id),
    };
    let presets = spec.presets.iter().map(|preset| preset.id);
    let params = spec.params.iter().copied().filter(has_param);
    let buttons = spec.buttons.iter().map(|button| button.id);
    presets
        .filter(|_| disclosure.is_all())
        .chain(params.map(|param| param.id))
        .chain(buttons.filter(|id| disclosure.has_button(id)))
        .collect()
}
