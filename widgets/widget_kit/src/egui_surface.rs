//! Draws on an egui painter.

use std::collections::HashMap;
use std::sync::Arc;

use egui::epaint::PathStroke;
use egui::{
    Color32, FontId, Galley, Painter, Pos2, Rect, Shape, Stroke, TextureHandle, TextureOptions,
    pos2, vec2,
};

use crate::palette::{self, Rgb, Theme};
use crate::scene::Raster;
use crate::surface::{Align, Measure, Pen, Px, PxRect, Surface, TextSize};

/// The textures of a widget's rasters, uploaded again only if a raster or the theme changes.
#[derive(Default)]
pub struct Textures {
    by_key: HashMap<String, Texture>,
}

struct Texture {
    revision: u64,
    size: [usize; 2],
    theme: Theme,
    handle: TextureHandle,
}

/// A painter as a [`Surface`].
pub struct EguiSurface<'a> {
    painter: Painter,
    whole: Rect,
    textures: &'a mut Textures,
    theme: Theme,
}

impl<'a> EguiSurface<'a> {
    /// Creates a surface that keeps its textures from frame to frame.
    #[must_use]
    pub fn new(painter: &Painter, textures: &'a mut Textures, theme: Theme) -> Self {
        Self {
            whole: painter.clip_rect(),
            painter: painter.clone(),
            textures,
            theme,
        }
    }

    fn texture(&mut self, raster: &Raster, key: &str) -> egui::TextureId {
        let size = [raster.columns, raster.rows];
        let theme = self.theme;
        let entry = self.textures.by_key.get_mut(key);
        if let Some(kept) = &entry
            && kept.revision == raster.revision
            && kept.size == size
            && kept.theme == theme
        {
            return kept.handle.id();
        }
        let image = image(raster, theme);
        let sampling = if raster.is_smooth() {
            TextureOptions::LINEAR
        } else {
            TextureOptions::NEAREST
        };
        let handle = match entry {
            Some(kept) => {
                kept.handle.set(image, sampling);
                kept.handle.clone()
            }
            None => self.painter.ctx().load_texture(key, image, sampling),
        };
        let id = handle.id();
        let texture = Texture {
            revision: raster.revision,
            size,
            theme,
            handle,
        };
        self.textures.by_key.insert(key.to_owned(), texture);
        id
    }
}

/// Row 0 of a raster is at the bottom, row 0 of an image at the top.
fn image(raster: &Raster, theme: Theme) -> egui::ColorImage {
    let mut pixels = Vec::with_capacity(raster.cells.len());
    for row in raster.cells.chunks(raster.columns).rev() {
        pixels.extend(row.iter().map(|cell| color(palette::cell(theme, *cell))));
    }
    egui::ColorImage::new([raster.columns, raster.rows], pixels)
}

/// A colour of the palette for egui.
#[must_use]
pub fn color([r, g, b]: Rgb) -> Color32 {
    Color32::from_rgb(r, g, b)
}

fn pos([x, y]: Px) -> Pos2 {
    pos2(x, y)
}

fn egui_rect(rect: PxRect) -> Rect {
    Rect::from_min_size(pos2(rect.left, rect.top), vec2(rect.width, rect.height))
}

/// Lays out a text without a colour, so that egui caches one layout for measuring and for every colour.
fn laid_out(painter: &Painter, text: &str, size: TextSize) -> Arc<Galley> {
    painter.layout_no_wrap(
        text.to_owned(),
        FontId::proportional(size.px()),
        Color32::PLACEHOLDER,
    )
}

/// Measures text with egui's fonts.
pub struct EguiMeasure(
    /// The painter whose fonts are measured.
    pub Painter,
);

impl Measure for EguiMeasure {
    fn text_width(&mut self, text: &str, size: TextSize) -> f32 {
        laid_out(&self.0, text, size).size().x
    }
}

impl Measure for EguiSurface<'_> {
    fn text_width(&mut self, text: &str, size: TextSize) -> f32 {
        EguiMeasure(self.painter.clone()).text_width(text, size)
    }
}

impl Surface for EguiSurface<'_> {
    fn clip(&mut self, rect: Option<PxRect>) {
        let rect = rect.map_or(self.whole, |rect| egui_rect(rect).intersect(self.whole));
        self.painter.set_clip_rect(rect);
    }

    fn line(&mut self, points: &[Px], pen: Pen) {
        let stroke = Stroke::new(pen.width, color(pen.color));
        match (pen.dashes(), points) {
            (Some((dash, gap)), _) => {
                let path: Vec<Pos2> = points.iter().copied().map(pos).collect();
                self.painter
                    .extend(Shape::dashed_line(&path, stroke, dash, gap));
            }
            (None, [a, b]) => {
                self.painter.line_segment([pos(*a), pos(*b)], stroke);
            }
            (None, _) => {
                let path = points.iter().copied().map(pos).collect();
                self.painter.line(path, PathStroke::from(stroke));
            }
        }
    }

    fn polygon(&mut self, points: &[Px], fill: Rgb) {
        let path = points.iter().copied().map(pos).collect();
        self.painter
            .add(Shape::convex_polygon(path, color(fill), Stroke::NONE));
    }

    fn fan(&mut self, from: Px, rim: &[Px], fill: Rgb, [inner, outer]: [f32; 2]) {
        let mut mesh = egui::Mesh::default();
        mesh.colored_vertex(pos(from), color(fill).gamma_multiply(inner));
        let outer = color(fill).gamma_multiply(outer);
        for (corner, at) in (1_u32..).zip(rim) {
            mesh.colored_vertex(pos(*at), outer);
            if corner > 1 {
                mesh.add_triangle(0, corner - 1, corner);
            }
        }
        self.painter.add(mesh);
    }

    fn circle(&mut self, center: Px, radius: f32, fill: Option<Rgb>, ring: Option<Pen>) {
        let fill = fill.map_or(Color32::TRANSPARENT, color);
        let ring = ring.map_or(Stroke::NONE, |pen| Stroke::new(pen.width, color(pen.color)));
        self.painter.circle(pos(center), radius, fill, ring);
    }

    fn rect(&mut self, rect: PxRect, fill: Rgb) {
        self.painter.rect_filled(egui_rect(rect), 0.0, color(fill));
    }

    fn raster(&mut self, rect: PxRect, raster: &Raster, key: &str) {
        if raster.cells.len() != raster.columns * raster.rows || raster.cells.is_empty() {
            return;
        }
        let texture = self.texture(raster, key);
        let uv = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        self.painter
            .image(texture, egui_rect(rect), uv, Color32::WHITE);
    }

    fn text(&mut self, at: Px, align: Align, text: &str, size: TextSize, ink: Rgb) {
        let anchor = match align {
            Align::Left => egui::Align2::LEFT_CENTER,
            Align::Center => egui::Align2::CENTER_CENTER,
            Align::Right => egui::Align2::RIGHT_CENTER,
        };
        let galley = laid_out(&self.painter, text, size);
        let place = anchor.anchor_size(pos(at), galley.size());
        self.painter.galley(place.min, galley, color(ink));
    }

    fn snap(&self, coordinate: f32) -> f32 {
        self.painter.round_to_pixel_center(coordinate)
    }
}
