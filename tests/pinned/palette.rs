//! The colours of `crates/robots/robot_io/palette.json` without a meaning in pictures.

use std::collections::BTreeMap;

use widget_kit::palette::{Rgb, Theme, accent, contrast, tone};
use widget_kit::scene::Tone;

use super::page::document::{page_style, source};

/// The shades of each colour, light and dark.
fn colors() -> BTreeMap<String, [Rgb; 2]> {
    let colors: BTreeMap<String, [String; 2]> =
        serde_json::from_str(&source("crates/robots/robot_io/palette.json")).expect("it is JSON");
    let parse = |shade: String| {
        let number = u32::from_str_radix(&shade[1..], 16).expect("#rrggbb");
        [(number >> 16) as u8, (number >> 8) as u8, number as u8]
    };
    let both = colors.into_iter();
    both.map(|(name, shades)| (name, shades.map(parse)))
        .collect()
}

#[test]
fn the_widgets_have_the_colours_of_the_file() {
    let colors = colors();
    for (theme, at) in [(Theme::Light, 0), (Theme::Dark, 1)] {
        for (name, shade) in [
            ("prior", tone(theme, Tone::Prior)),
            ("posterior", tone(theme, Tone::Posterior)),
            ("paper", tone(theme, Tone::Paper)),
            ("accent", accent(theme)),
        ] {
            assert_eq!(shade, colors[name][at], "{name}");
        }
    }
}

#[test]
fn text_is_readable_in_both_themes() {
    let colors = colors();
    let code = [
        "posterior",
        "link",
        "code-number",
        "measurement",
        "ink-soft",
    ];
    for (at, theme) in ["light", "dark"].into_iter().enumerate() {
        for back in ["paper", "wash"] {
            for words in code.into_iter().chain(["ink", "soft", "accent"]) {
                let ratio = contrast(colors[words][at], colors[back][at]);
                // WCAG 2.2, 1.4.3.
                assert!(ratio >= 4.5, "{words} on {back}, {theme}: {ratio:.1}:1");
            }
        }
    }
}

/// A colour that the file lacks would be inherited, in one theme or in both.
#[test]
fn the_styles_declare_no_colour_of_their_own_and_use_none_that_is_missing() {
    let colors = colors();
    let style = page_style();
    let own = style.split("--").skip(1).filter_map(|tail| {
        let (name, value) = tail.split_once(": ")?;
        value.starts_with('#').then_some(name)
    });
    assert_eq!(own.collect::<Vec<_>>(), [""; 0]);
    let lengths = ["text-font", "label-font", "measure", "wide", "gutter"];
    for used in style.split("var(--").skip(1) {
        let name = used.split([')', ',']).next().unwrap_or_default();
        let is_declared = style.contains(&format!("  --{name}: "));
        assert!(
            colors.contains_key(name) || lengths.contains(&name) || is_declared,
            "--{name} is no colour of crates/robots/robot_io/palette.json"
        );
    }
}
