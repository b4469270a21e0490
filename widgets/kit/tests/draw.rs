//! What is drawn over data and in legends can be read.

use kit::draw;
use kit::layout::{PanelLayout, PlotHeight};
use kit::palette::{Theme, tone};
use kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};
use kit::svg::SvgSurface;

fn svg_of(layers: Vec<Layer>, legend: Vec<LegendEntry>, theme: Theme) -> String {
    let panel = Panel {
        id: "map",
        title: "Map".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: Axis::new("x (m)", 0.0, 4.0),
        y: Axis::new("y (m)", 0.0, 3.0),
        layers,
        legend,
        color_bar: None,
    };
    let mut svg = SvgSurface::new(theme);
    let layout = PanelLayout::new(&panel, 300.0, PlotHeight::Fixed(200.0), &mut svg);
    let window = panel.bounds();
    draw::panel(&mut svg, &panel, &layout, [0.0, 0.0], &window, theme);
    svg.finish(300.0, 300.0, "")
}

fn label(text: &str, tone: Tone) -> Layer {
    Layer::Text {
        at: [2.0, 1.0],
        text: text.to_owned(),
        tone,
    }
}

/// The elements that write this text, from the lowest up.
fn writings<'a>(svg: &'a str, text: &str) -> Vec<&'a str> {
    svg.split("<text ")
        .filter(|element| element.contains(&format!(">{text}</text>")))
        .collect()
}

#[test]
fn a_label_over_data_stands_on_a_halo_of_paper() {
    for theme in [Theme::Light, Theme::Dark] {
        let css = |[r, g, b]: [u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
        let paper = css(tone(theme, Tone::Paper));
        let ink = css(tone(theme, Tone::Ink));
        let svg = svg_of(vec![label("Room A", Tone::Ink)], Vec::new(), theme);
        let [halo, letters] = writings(&svg, "Room A")[..] else {
            panic!("not one halo and one text: {svg}");
        };
        assert!(halo.contains(&format!("stroke=\"{paper}\"")), "{halo}");
        assert!(halo.contains("aria-hidden"), "it would be read out twice");
        assert!(letters.contains(&format!("fill=\"{ink}\"")), "{letters}");
        assert!(!letters.contains("stroke"), "{letters}");
    }
}

#[test]
fn a_letter_on_the_area_of_its_class_needs_no_halo() {
    let svg = svg_of(vec![label("Q", Tone::Class(1))], Vec::new(), Theme::Light);
    assert_eq!(writings(&svg, "Q").len(), 1);
}

#[test]
fn two_dashes_show_on_either_side_of_a_legends_mark() {
    let truth = LegendEntry::marked_line("truth", Tone::Truth, Mark::Plus, Stroke::Dashed);
    let svg = svg_of(Vec::new(), vec![truth], Theme::Light);
    let dashed = svg
        .split("<path ")
        .find(|path| path.contains("dasharray=\"6 4\""));
    let outline = dashed.and_then(|path| path.split("d=\"").nth(1)).unwrap();
    let outline = &outline[..outline.find('"').unwrap()];
    let sides: Vec<[f32; 2]> = outline
        .split('M')
        .skip(1)
        .map(|side| {
            let ends = side.split('L').map(|at| at.split(' ').next().unwrap());
            let ends: Vec<f32> = ends.map(|x| x.parse().unwrap()).collect();
            [ends[0], ends[1]]
        })
        .collect();
    let [[left, to_mark], [right, from_mark]] = sides[..] else {
        panic!("not one line on each side of the mark: {outline}");
    };
    // Two dashes of 6 with a gap of 4 between them.
    assert!(
        to_mark - left >= 16.0 && right - from_mark >= 16.0,
        "{outline}"
    );
    // The mark reaches 5 to either side of the middle.
    assert!(from_mark - to_mark >= 10.0, "{outline}");
}
