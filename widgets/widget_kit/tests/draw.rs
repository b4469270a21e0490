//! Text over data and in legends is readable.

use widget_kit::draw;
use widget_kit::layout::{PanelLayout, PlotHeight};
use widget_kit::palette::{Theme, tone};
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};
use widget_kit::svg::SvgSurface;

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

/// The elements that draw this text, from bottom to top.
fn writings<'a>(svg: &'a str, text: &str) -> Vec<&'a str> {
    svg.split("<text ")
        .filter(|element| element.contains(&format!(">{text}</text>")))
        .collect()
}

#[test]
fn a_label_over_data_has_a_halo_of_paper() {
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
    // The mark extends 5 to either side of the middle.
    assert!(from_mark - to_mark >= 10.0, "{outline}");
}

/// Width of the clip rectangle around the circles of a panel with these points, and the number of circles.
fn clip_of_circles(points: Vec<[f64; 2]>) -> (f64, usize) {
    let layer = Layer::points(points, Mark::Circle, Tone::Posterior, 6.0);
    let svg = svg_of(vec![layer], Vec::new(), Theme::Light);
    let parts = svg.split("<clipPath").skip(1);
    let drawn: Vec<_> = parts
        .map(|part| (part, part.matches("a6.0 6.0 0 1 0 12.0").count()))
        .filter(|(_, circles)| *circles > 0)
        .collect();
    let [(part, circles)] = drawn[..] else {
        panic!("the circles have one clip: {svg}");
    };
    let (_, width) = part.split_once("width=\"").unwrap();
    (width.split_once('"').unwrap().0.parse().unwrap(), circles)
}

#[test]
fn a_mark_at_the_edge_of_a_plot_is_complete_and_one_beyond_it_is_clipped() {
    let (plot, one) = clip_of_circles(vec![[2.0, 1.0]]);
    assert_eq!(one, 1);
    // A radius, and two pixels for the stroke on either side.
    let at_the_edge = clip_of_circles(vec![[2.0, 1.0], [4.0, 1.0]]);
    assert_eq!(at_the_edge, (plot + 16.0, 2));
    let beyond = clip_of_circles(vec![[4.0, 1.0], [4.05, 1.0]]);
    assert_eq!(beyond, (plot, 2));
}

#[test]
fn a_cloud_at_the_edge_is_clipped() {
    let (plot, _) = clip_of_circles(vec![[2.0, 1.0]]);
    let cloud = (0..=40).map(|k| [0.1 * f64::from(k), 1.0]).collect();
    assert_eq!(clip_of_circles(cloud), (plot, 41));
}

#[test]
fn names_of_an_axis_do_not_lie_on_each_other_however_low_the_plot() {
    let names = [
        "predict",
        "register",
        "keyframe",
        "candidate",
        "fit",
        "gate",
    ];
    let panel = Panel {
        id: "lanes",
        title: "Lanes".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new("tick", 0.0, 129.0),
        y: Axis::from_names("lane", names.map(str::to_owned)),
        layers: Vec::new(),
        legend: Vec::new(),
        color_bar: None,
    };
    let mut svg = SvgSurface::new(Theme::Light);
    let layout = PanelLayout::new(&panel, 340.0, PlotHeight::Fixed(20.0), &mut svg);
    draw::panel(
        &mut svg,
        &panel,
        &layout,
        [0.0, 0.0],
        &panel.bounds(),
        Theme::Light,
    );
    let svg = svg.finish(340.0, 300.0, "");
    let y = |name: &str| -> f64 {
        let element = writings(&svg, name)[0];
        let (_, rest) = element.split_once(" y=\"").expect("a place");
        rest.split('"').next().unwrap().parse().unwrap()
    };
    for pair in names.windows(2) {
        // Letters of small text are 10 px high, and the first name stands below the second.
        assert!(y(pair[0]) - y(pair[1]) >= 11.5, "{pair:?}: {svg}");
    }
    // They stand left of the plot, and what is drawn in it right of them.
    assert!(layout.plot.left > 50.0);
}

/// Names of points that lie on each other: one stands beside its point, the last ones have to move away.
#[test]
fn a_name_that_moved_away_has_a_line_to_its_point() {
    let lines = |names: &[&str]| {
        let layers = names
            .iter()
            .map(|name| Layer::label([2.0, 1.5], (*name).to_owned(), 8.0));
        let svg = svg_of(layers.collect(), Vec::new(), Theme::Light);
        // Border, ticks and grid are drawn in any case.
        svg.matches('L').count()
    };
    let without = lines(&[]);
    assert_eq!(lines(&["plain"]), without);
    let many = [
        "plain", "trimmed", "Huber", "a", "b", "c", "d", "e", "f", "g",
    ];
    assert!(lines(&many) > without);
}
