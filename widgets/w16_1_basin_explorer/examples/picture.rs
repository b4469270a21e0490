//! Prints the widget's static picture as SVG: `picture [WIDTH] [light|dark] [PRESET]`.

use kit::model::{Activity, Model};
use kit::palette::Theme;
use kit::svg::picture_svg;
use w16_1_basin_explorer::model::BasinExplorer;
use w16_1_basin_explorer::view::BasinView;

fn main() -> Result<(), Box<dyn core::error::Error>> {
    let mut args = std::env::args().skip(1);
    let width = args.next().map_or(Ok(1100.0), |text| text.parse())?;
    let theme = match args.next().as_deref() {
        Some("dark") => Theme::Dark,
        _ => Theme::Light,
    };
    let mut explorer = BasinExplorer::new();
    if let Some(preset) = args.next() {
        explorer.press(&preset)?;
        while explorer.advance(0.1) == Activity::Busy {}
    }
    while explorer.work() == Activity::Busy {}
    println!("{}", picture_svg(&explorer, &BasinView, width, theme));
    Ok(())
}
