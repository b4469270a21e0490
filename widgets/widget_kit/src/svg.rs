//! A static picture of a widget: for pages without WebAssembly, for print, for the README.

mod png;

use core::fmt::Write as _;

use crate::model::Model;
use crate::palette::{self, Rgb, Theme, tone};
use crate::picture::{self, picture, scene_picture};
use crate::scene::{Raster, Scene, Tone};
use crate::surface::{Align, HALO_WIDTH, Haloed, Measure, Pen, Px, PxRect, Surface, TextSize};
use crate::view::View;

/// Renders the picture of a widget's current state.
#[must_use]
pub fn picture_svg(model: &dyn Model, view: View, width_px: f32, theme: Theme) -> String {
    let mut svg = SvgSurface::new(theme);
    let height = picture(&mut svg, model, view, width_px, theme);
    let spec = model.spec();
    svg.finish(width_px, height, &format!("{} {}", spec.id, spec.title))
}

/// Renders only the panels of a scene, for embedding in a page with other pictures; `prefix` makes its
/// element names unique.
#[must_use]
pub fn scene_svg(scene: &Scene, title: &str, prefix: &str, width_px: f32, theme: Theme) -> String {
    let mut svg = SvgSurface::new(theme);
    prefix.clone_into(&mut svg.prefix);
    let height = scene_picture(&mut svg, scene, width_px, theme);
    svg.finish(width_px, height, title)
}

/// Positions on the picture of [`scene_svg`] of points, each of a named panel.
#[must_use]
pub fn scene_places(scene: &Scene, width_px: f32, points: &[(&str, [f64; 2])]) -> Vec<Px> {
    let mut measure = SvgSurface::new(Theme::Light);
    picture::scene_places(&mut measure, scene, width_px, points)
}

/// Writes SVG elements.
///
/// Consecutive shapes with the same style share one `path` element, because thousands of points would repeat
/// their colour otherwise.
pub struct SvgSurface {
    theme: Theme,
    body: String,
    /// Style and outline of the current path.
    path: (String, String),
    /// Prefix of the names in this picture: several pictures may be in one page.
    prefix: String,
    clips: usize,
    clipped: bool,
}

impl SvgSurface {
    /// An empty picture.
    #[must_use]
    pub fn new(theme: Theme) -> Self {
        Self {
            theme,
            body: String::new(),
            path: Default::default(),
            prefix: String::new(),
            clips: 0,
            clipped: false,
        }
    }

    /// The whole document.
    #[must_use]
    pub fn finish(mut self, width: f32, height: f32, title: &str) -> String {
        self.clip(None);
        let (width, height) = (width.ceil(), height.ceil());
        let paper = css(tone(self.theme, Tone::Paper));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" \
             font-family=\"'Public Sans', system-ui, 'Segoe UI', sans-serif\">\
             <title>{}</title><rect width=\"{width}\" height=\"{height}\" fill=\"{paper}\"/>{}</svg>",
            escape(title),
            self.body
        )
    }

    fn element(&mut self, element: core::fmt::Arguments) {
        self.close_path();
        // Writing to a string cannot fail.
        let _ = self.body.write_fmt(element);
    }

    /// Adds an outline in that style.
    fn path(&mut self, look: &str, outline: &str) {
        if self.path.0 != look {
            self.close_path();
            look.clone_into(&mut self.path.0);
        }
        self.path.1.push_str(outline);
    }

    fn close_path(&mut self) {
        let (look, outline) = core::mem::take(&mut self.path);
        if !outline.is_empty() {
            let _ = write!(self.body, "<path {look} d=\"{outline}\"/>");
        }
    }

    fn words(&mut self, [x, y]: Px, align: Align, text: &str, size: TextSize, look: &str) {
        let anchor = match align {
            Align::Left => "start",
            Align::Center => "middle",
            Align::Right => "end",
        };
        let px = size.px();
        // The middle of lower-case letters is a third of the font size above the base line.
        let base = y + 0.35 * px;
        self.element(format_args!(
            "<text x=\"{x:.1}\" y=\"{base:.1}\" font-size=\"{px}\" text-anchor=\"{anchor}\" \
             {look}>{}</text>",
            escape(text)
        ));
    }
}

impl Measure for SvgSurface {
    /// An estimate: the page has the font, and a picture on its own a similar one.
    fn text_width(&mut self, text: &str, size: TextSize) -> f32 {
        let ems: f32 = text.chars().map(char_width_em).sum();
        ems * size.px()
    }
}

/// Width of a character in Public Sans at weight 500, in em, rounded up.
fn char_width_em(c: char) -> f32 {
    match c {
        '.' | ',' | ':' | ';' | ' ' | '\u{202f}' | '\'' | 'i' | '|' | '·' | '’' => 0.27,
        'j' | 'l' | 'I' | '(' | ')' | '[' | ']' => 0.32,
        'f' | 't' | 'r' | '-' | '/' | 'J' | '1' | '²' => 0.41,
        'c' | 'y' | 's' | 'v' | 'z' | '°' | '?' | 'χ' => 0.54,
        'm' | 'M' | 'W' | '%' | '@' => 0.96,
        'w' | 'A'..='Z' | '…' | '→' => 0.76,
        _ => 0.64,
    }
}

impl Surface for SvgSurface {
    fn clip(&mut self, rect: Option<PxRect>) {
        self.close_path();
        if core::mem::replace(&mut self.clipped, rect.is_some()) {
            self.body.push_str("</g>");
        }
        if let Some(PxRect {
            left,
            top,
            width,
            height,
        }) = rect
        {
            self.clips += 1;
            let id = format!("{}c{}", self.prefix, self.clips);
            self.element(format_args!(
                "<clipPath id=\"{id}\"><rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" \
                 height=\"{height:.1}\"/></clipPath><g clip-path=\"url(#{id})\">"
            ));
        }
    }

    fn line(&mut self, points: &[Px], pen: Pen) {
        self.path(
            &format!("fill=\"none\" {}", pen_attributes(pen)),
            &outline(points),
        );
    }

    fn polygon(&mut self, points: &[Px], fill: Rgb) {
        let look = format!("fill=\"{}\"", css(fill));
        self.path(&look, &format!("{}Z", outline(points)));
    }

    /// With one opacity, because an SVG has no colours at corners.
    fn fan(&mut self, from: Px, rim: &[Px], fill: Rgb, [inner, outer]: [f32; 2]) {
        let opacity = 0.5 * (inner + outer);
        let look = format!("fill=\"{}\" fill-opacity=\"{opacity:.2}\"", css(fill));
        let corners: Vec<Px> = core::iter::once(from).chain(rim.iter().copied()).collect();
        self.element(format_args!("<path {look} d=\"{}Z\"/>", outline(&corners)));
    }

    fn circle(&mut self, [x, y]: Px, radius: f32, fill: Option<Rgb>, ring: Option<Pen>) {
        let look = format!(
            "fill=\"{}\" {}",
            fill.map_or("none".to_owned(), css),
            ring.map_or(String::new(), pen_attributes)
        );
        // Two half circles, there and back.
        let (left, width) = (x - radius, 2.0 * radius);
        let outline = format!(
            "M{left:.1} {y:.1}a{radius:.1} {radius:.1} 0 1 0 {width:.1} 0\
             a{radius:.1} {radius:.1} 0 1 0 -{width:.1} 0Z"
        );
        self.path(&look, &outline);
    }

    fn rect(&mut self, rect: PxRect, fill: Rgb) {
        let PxRect {
            left,
            top,
            width,
            height,
        } = rect;
        self.element(format_args!(
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
             fill=\"{}\"/>",
            css(fill)
        ));
    }

    fn raster(&mut self, rect: PxRect, raster: &Raster, _key: &str) {
        if raster.cells.len() != raster.columns * raster.rows || raster.cells.is_empty() {
            return;
        }
        let rows = raster.cells.chunks(raster.columns).rev();
        let pixels: Vec<Rgb> = rows
            .flatten()
            .map(|cell| palette::cell(self.theme, *cell))
            .collect();
        let data = png::data_url(&pixels, raster.columns, raster.rows);
        let PxRect {
            left,
            top,
            width,
            height,
        } = rect;
        let rendering = if raster.is_smooth() {
            "auto"
        } else {
            "pixelated"
        };
        self.element(format_args!(
            "<image x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
             preserveAspectRatio=\"none\" style=\"image-rendering:{rendering}\" href=\"{data}\"/>"
        ));
    }

    fn text(&mut self, at: Px, align: Align, text: &str, size: TextSize, color: Rgb) {
        self.words(at, align, text, size, &format!("fill=\"{}\"", css(color)));
    }

    fn haloed_text(&mut self, at: Px, align: Align, text: &str, size: TextSize, colors: Haloed) {
        // A separate stroke below the letters, because not every SVG renderer supports paint-order.
        let halo = css(colors.halo);
        let width = 2.0 * HALO_WIDTH;
        let look = format!(
            "fill=\"{halo}\" stroke=\"{halo}\" stroke-width=\"{width}\" \
             stroke-linejoin=\"round\" aria-hidden=\"true\""
        );
        self.words(at, align, text, size, &look);
        self.text(at, align, text, size, colors.ink);
    }

    fn snap(&self, coordinate: f32) -> f32 {
        coordinate.floor() + 0.5
    }
}

fn outline(points: &[Px]) -> String {
    let mut outline = String::with_capacity(12 * points.len());
    for (index, [x, y]) in points.iter().enumerate() {
        let command = if index == 0 { 'M' } else { 'L' };
        let _ = write!(outline, "{command}{x:.1} {y:.1}");
    }
    outline
}

fn pen_attributes(pen: Pen) -> String {
    let mut attributes = format!(
        "stroke=\"{}\" stroke-width=\"{:.2}\"",
        css(pen.color),
        pen.width
    );
    if let Some((dash, gap)) = pen.dashes() {
        let _ = write!(attributes, " stroke-dasharray=\"{dash} {gap}\"");
    }
    attributes
}

fn css([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Escapes a text for XML.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c => escaped.push(c),
        }
    }
    escaped
}
