//! The JavaScript interface: one object per widget, text and JSON in and out.

use std::cell::{Cell, OnceCell, RefCell};
use std::rc::Rc;
use std::time::Duration;

use wasm_bindgen::prelude::*;
use widget_kit::host_messages::Delivery;
use widget_kit::model::Motion;
use widget_kit::palette::Theme;
use widget_kit::param::{ParamError, ParamSpec};
use widget_kit::zoom::Look;

use crate::app::{Shared, WidgetApp, apply_theme, theme_of, web_options};
use widgets::registry;

use crate::{app, state};

/// A widget, with or without a canvas.
#[wasm_bindgen]
pub struct Widget {
    shared: Rc<Shared>,
    runner: eframe::WebRunner,
    /// Context for layouts without drawing.
    measuring: OnceCell<egui::Context>,
}

#[wasm_bindgen]
impl Widget {
    /// Creates a widget of that name, not running yet.
    ///
    /// # Errors
    /// If there is no such widget.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str) -> Result<Self, JsError> {
        let shell = registry::find(name).map_err(|problem| JsError::new(&problem))?();
        let shared = Shared {
            shell: RefCell::new(shell),
            ctx: RefCell::new(None),
            theme: Cell::new(Theme::Light),
            scale: Cell::new(1.0),
            frames: Cell::new(0),
            dragging: Cell::new(false),
            pointer: Cell::new(None),
            cancelled: Cell::new(false),
            engaged: Cell::new(false),
        };
        Ok(Self {
            shared: Rc::new(shared),
            runner: eframe::WebRunner::new(),
            measuring: OnceCell::new(),
        })
    }

    /// Runs the widget on a canvas. Once per object: create a new one after a stop.
    ///
    /// # Errors
    /// If the browser provides no WebGL.
    pub async fn start(&self, canvas: web_sys::HtmlCanvasElement) -> Result<(), JsValue> {
        let shared = Rc::clone(&self.shared);
        let create: eframe::AppCreator<'static> =
            Box::new(move |creation| Ok(Box::new(WidgetApp::new(&creation.egui_ctx, shared))));
        self.runner
            .start(canvas, web_options(&self.shared), create)
            .await
    }

    /// Stops permanently and releases the resources.
    pub fn destroy(&self) {
        self.runner.destroy();
        *self.shared.ctx.borrow_mut() = None;
    }

    /// Whether the code panicked; then only [`Widget::panic_message`] may be called.
    #[wasm_bindgen(js_name = hasPanicked)]
    pub fn has_panicked(&self) -> bool {
        self.runner.has_panicked()
    }

    /// The message of the panic, with its call stack.
    #[wasm_bindgen(js_name = panicMessage)]
    pub fn panic_message(&self) -> Option<String> {
        let summary = self.runner.panic_summary()?;
        Some(format!("{}\n\n{}", summary.message(), summary.callstack()))
    }

    /// Panics, to test a host's recovery.
    ///
    /// # Panics
    /// Always.
    #[wasm_bindgen(js_name = crashForTest)]
    pub fn crash_for_test(&self) {
        panic!("crashed on purpose, to test the recovery");
    }

    /// The value of a parameter as a number.
    ///
    /// # Errors
    /// If the widget has no such parameter.
    pub fn number(&self, id: &str) -> Result<f64, JsError> {
        Ok(self.find(id)?.1)
    }

    /// The value of a parameter in the form of a link.
    ///
    /// # Errors
    /// If the widget has no such parameter.
    pub fn text(&self, id: &str) -> Result<String, JsError> {
        let (spec, _) = self.find(id)?;
        Ok(self.shared.shell.borrow().model().values().to_text(spec.id))
    }

    /// Sets a parameter from the text of a link or an attribute.
    ///
    /// # Errors
    /// A sentence with the valid values; the old value remains.
    pub fn set(&self, id: &str, text: &str) -> Result<(), JsError> {
        self.shared
            .shell
            .borrow_mut()
            .model_mut()
            .set_text(id, text)?;
        self.shared.request_repaint();
        Ok(())
    }

    /// Presses a button or a preset; nothing happens if it has nothing to do.
    ///
    /// # Errors
    /// If the widget has no such button.
    pub fn press(&self, id: &str) -> Result<(), JsError> {
        self.shared.shell.borrow_mut().press(id)?;
        self.shared.request_repaint();
        Ok(())
    }

    /// Records that the reader has acted: the verdict takes the place of the gesture.
    pub fn act(&self) {
        self.shared.shell.borrow_mut().act();
        self.shared.request_repaint();
    }

    /// Whether the reader has acted.
    #[wasm_bindgen(js_name = hasActed)]
    pub fn has_acted(&self) -> bool {
        self.shared.shell.borrow().has_acted()
    }

    /// Whether the gesture stands in place of the verdict.
    pub fn asks(&self) -> bool {
        self.shared.shell.borrow().asks()
    }

    /// Passes a delivery of the host to the widget: a kind, words, numbers, bytes.
    pub fn deliver(&self, kind: &str, text: &str, numbers: &[f64], bytes: &[u8]) {
        let delivery = Delivery {
            kind,
            text,
            numbers,
            bytes,
        };
        let mut shell = self.shared.shell.borrow_mut();
        shell.model_mut().receive(&delivery);
        drop(shell);
        self.shared.request_repaint();
    }

    /// The widget's requests to its host since the last call.
    #[wasm_bindgen(js_name = takeOrders)]
    pub fn take_requests(&self) -> Vec<String> {
        self.shared.shell.borrow_mut().take_requests()
    }

    /// The controls that are shown at present, by name.
    #[wasm_bindgen(js_name = shownControls)]
    pub fn shown_controls(&self) -> Vec<String> {
        let shell = self.shared.shell.borrow();
        let shown = widget_kit::controls::shown(shell.model());
        shown.into_iter().map(str::to_owned).collect()
    }

    /// The buttons that have nothing to do at present, and those shown as pressed, as JSON.
    #[wasm_bindgen(js_name = buttonStates)]
    pub fn button_states(&self) -> String {
        state::buttons(&self.shared.shell.borrow()).to_string()
    }

    /// The facts and tables that are shown, as JSON.
    pub fn details(&self) -> String {
        state::details(self.shared.shell.borrow().model()).to_string()
    }

    /// Every value as JSON, in the form of a link.
    pub fn values(&self) -> String {
        state::values(self.shared.shell.borrow().model()).to_string()
    }

    /// The result as JSON: standing, verdict, sentence, facts.
    pub fn outcome(&self) -> String {
        state::outcome(&self.shared.shell.borrow().model().outcome()).to_string()
    }

    /// The text alternative of the picture.
    pub fn summary(&self) -> String {
        self.shared.shell.borrow().summary()
    }

    /// The timeline as JSON, or `null`.
    pub fn timeline(&self) -> String {
        state::timeline(self.shared.shell.borrow().model().timeline().as_ref()).to_string()
    }

    /// Every table as JSON with its CSV.
    pub fn tables(&self) -> String {
        state::tables(&self.shared.shell.borrow().model().tables()).to_string()
    }

    /// `light` or `dark`; anything else is light.
    #[wasm_bindgen(js_name = setTheme)]
    pub fn set_theme(&self, name: &str) {
        let theme = theme_of(name);
        self.shared.theme.set(theme);
        self.shared.shell.borrow_mut().set_theme(theme);
        if let Some(ctx) = &*self.shared.ctx.borrow() {
            apply_theme(ctx, theme);
        }
        self.shared.request_repaint();
    }

    /// Whether animations run.
    #[wasm_bindgen(js_name = setReducedMotion)]
    pub fn set_reduced_motion(&self, reduced: bool) {
        self.shared.shell.borrow_mut().set_motion(if reduced {
            Motion::Reduced
        } else {
            Motion::Full
        });
    }

    /// Sets how much larger than usual the page's text is: that of the picture follows.
    #[wasm_bindgen(js_name = setTypeScale)]
    pub fn set_type_scale(&self, scale: f32) {
        self.shared.scale.set(scale);
        self.shared.request_repaint();
    }

    /// The effect of the handle under the pointer, which the page shows beside it.
    #[must_use]
    pub fn handle(&self) -> Option<String> {
        self.shared.shell.borrow().handle().map(str::to_owned)
    }

    /// Whether a map is zoomed.
    #[wasm_bindgen(js_name = isZoomed)]
    pub fn is_zoomed(&self) -> bool {
        self.shared.shell.borrow().is_zoomed()
    }

    /// Zooms every map or moves its zoomed part: `in`, `out`, `left`, `right`, `up`, `down`, `whole`.
    ///
    /// # Errors
    /// If the name is unknown.
    pub fn look(&self, way: &str) -> Result<(), JsError> {
        let known = || Look::NAMES.map(|(name, _)| name).join(", ");
        let look = Look::named(way)
            .ok_or_else(|| JsError::new(&format!("one looks {}, not `{way}`", known())))?;
        self.shared.shell.borrow_mut().look(look);
        self.shared.request_repaint();
        Ok(())
    }

    /// Whether something draggable is at that point of the canvas (CSS pixels).
    #[wasm_bindgen(js_name = dragsAt)]
    pub fn drags_at(&self, x: f32, y: f32) -> bool {
        let scale = self.shared.scale.get();
        self.shared.drags_at(egui::pos2(x / scale, y / scale))
    }

    /// Position of a panel's point (units of its axes) on the canvas (CSS pixels).
    #[wasm_bindgen(js_name = panelToScreen)]
    pub fn panel_to_screen(&self, panel: &str, x: f64, y: f64) -> Option<Vec<f32>> {
        let shell = self.shared.shell.borrow();
        let at = shell.panel_to_screen(panel, [x, y])?;
        Some(self.shared.to_css(at).to_vec())
    }

    /// The rectangle of the picture on the canvas: left, top, width, height in CSS pixels.
    #[wasm_bindgen(js_name = sceneBox)]
    pub fn scene_box(&self) -> Option<Vec<f32>> {
        let rect = self.shared.shell.borrow().scene_rect()?;
        let box_points = [rect.left, rect.top, rect.width, rect.height];
        Some(self.shared.to_css(box_points).to_vec())
    }

    /// Ends every drag after a cancelled touch.
    #[wasm_bindgen(js_name = releaseDrags)]
    pub fn release_drags(&self) {
        self.shared.cancelled.set(true);
        self.shared.request_repaint();
    }

    /// Height of the picture at the width of its last frame, CSS pixels.
    #[wasm_bindgen(js_name = contentHeight)]
    pub fn content_height(&self) -> f32 {
        let height = self.shared.shell.borrow().content_height();
        self.shared.to_css([height])[0]
    }

    /// Height of its part above the plots that More opens, CSS pixels.
    #[wasm_bindgen(js_name = stageHeight)]
    pub fn stage_height(&self) -> f32 {
        let height = self.shared.shell.borrow().stage_height();
        self.shared.to_css([height])[0]
    }

    /// Sets the height in CSS pixels that stays free for the controls above the plots that More opens.
    #[wasm_bindgen(js_name = setGap)]
    pub fn set_gap(&self, height_px: f32) {
        let height = height_px / self.shared.scale.get();
        self.shared.shell.borrow_mut().set_gap(height);
        self.shared.request_repaint();
    }

    /// Sets the available height for the picture, in CSS pixels.
    #[wasm_bindgen(js_name = setRoom)]
    pub fn set_room(&self, height_px: f32) {
        let height = height_px / self.shared.scale.get();
        self.shared.shell.borrow_mut().set_room(height);
        self.shared.request_repaint();
    }

    /// The height of the picture at that width, both in CSS pixels, laid out without a canvas.
    #[wasm_bindgen(js_name = heightAt)]
    pub fn height_at(&self, width_px: f32) -> f32 {
        let ctx = self.measuring.get_or_init(|| {
            let ctx = egui::Context::default();
            crate::fonts::install(&ctx);
            ctx
        });
        app::height_at(ctx, &mut self.shared.shell.borrow_mut(), width_px)
    }

    /// Whether another frame is needed: for playback, an animation or pending work.
    #[wasm_bindgen(js_name = wantsFrame)]
    pub fn wants_frame(&self) -> bool {
        let ctx = self.shared.ctx.borrow();
        self.shared.shell.borrow().is_busy()
            || ctx
                .as_ref()
                .is_some_and(egui::Context::has_requested_repaint)
    }

    /// Requests one more frame.
    #[wasm_bindgen(js_name = requestFrame)]
    pub fn request_frame(&self) {
        self.shared.request_repaint();
    }

    /// Number of laid out frames since the start.
    pub fn frames(&self) -> u32 {
        self.shared.frames.get()
    }

    /// Finishes pending work, so that outcome, texts and tables match the values. Returns whether there was
    /// any.
    pub fn finish_work(&self) -> bool {
        self.shared.shell.borrow_mut().finish_work()
    }

    /// Does pending work for about that long. Returns whether there was any.
    pub fn settle(&self, budget_ms: u32) -> bool {
        let budget = Duration::from_millis(u64::from(budget_ms));
        self.shared.shell.borrow_mut().settle(budget)
    }

    /// Finishes all progressive work, for a picture of the final state.
    pub fn finish(&self) {
        let mut shell = self.shared.shell.borrow_mut();
        while shell.model_mut().work().is_busy() {}
    }

    /// The picture as SVG, for print and for pages that cannot run the widget.
    pub fn picture(&self, width_px: f32, theme: &str) -> String {
        self.finish_work();
        self.shared
            .shell
            .borrow()
            .picture_svg(width_px, theme_of(theme))
    }

    fn find(&self, id: &str) -> Result<(&'static ParamSpec, f64), ParamError> {
        let shell = self.shared.shell.borrow();
        let model = shell.model();
        model.values().find_for(model.spec().id, id)
    }
}
