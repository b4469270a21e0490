//! Colours differ for every common kind of colour vision, and text is readable.

use widget_kit::model::Assessment;
use widget_kit::palette::{Rgb, Theme, cell, contrast, level_color, readable_on, standing, tone};
use widget_kit::scene::{RasterCell, Tone};

const THEMES: [Theme; 2] = [Theme::Light, Theme::Dark];
const MEANINGS: [Tone; 5] = [
    Tone::Prior,
    Tone::Prediction,
    Tone::Measurement,
    Tone::Posterior,
    Tone::Truth,
];

type Matrix = [[f32; 3]; 3];

/// Linear RGB as seen with full protanopia and deuteranopia (Machado, Oliveira & Fernandes 2009, severity 1).
const VISIONS: [(&str, Matrix); 3] = [
    ("usual", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    (
        "protanopia",
        [
            [0.152_286, 1.052_583, -0.204_868],
            [0.114_503, 0.786_281, 0.099_216],
            [-0.003_882, -0.048_116, 1.051_998],
        ],
    ),
    (
        "deuteranopia",
        [
            [0.367_322, 0.860_646, -0.227_968],
            [0.280_085, 0.672_501, 0.047_413],
            [-0.011_820, 0.042_940, 0.968_881],
        ],
    ),
];

/// Smallest CIE76 distance of two colours that must not be confused: about six times the just noticeable 2.3
/// (Mahy, Van Eycken & Oosterlinck 1994).
const APART: f32 = 15.0;

fn linear(color: Rgb) -> [f32; 3] {
    color.map(|channel| {
        let share = f32::from(channel) / 255.0;
        if share <= 0.040_45 {
            share / 12.92
        } else {
            ((share + 0.055) / 1.055).powf(2.4)
        }
    })
}

fn times(matrix: &Matrix, v: [f32; 3]) -> [f32; 3] {
    core::array::from_fn(|i| (0..3).map(|j| matrix[i][j] * v[j]).sum())
}

/// CIE L*a*b* of linear sRGB, white point D65.
fn lab(rgb: [f32; 3]) -> [f32; 3] {
    const XYZ: Matrix = [
        [0.412_456_4, 0.357_576_1, 0.180_437_5],
        [0.212_672_9, 0.715_152_2, 0.072_175],
        [0.019_333_9, 0.119_192, 0.950_304_1],
    ];
    const WHITE: [f32; 3] = [0.950_47, 1.0, 1.088_83];
    let xyz = times(&XYZ, rgb);
    let f: [f32; 3] = core::array::from_fn(|i| {
        let t = xyz[i] / WHITE[i];
        if t > 216.0 / 24_389.0 {
            t.cbrt()
        } else {
            (24_389.0 / 27.0 * t + 16.0) / 116.0
        }
    });
    [
        116.0 * f[1] - 16.0,
        500.0 * (f[0] - f[1]),
        200.0 * (f[1] - f[2]),
    ]
}

fn distance(a: Rgb, b: Rgb, vision: &Matrix) -> f32 {
    let seen = |color| lab(times(vision, linear(color)).map(|v| v.clamp(0.0, 1.0)));
    let (a, b) = (seen(a), seen(b));
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f32>().sqrt()
}

fn assert_apart(colors: &[Rgb], what: &str) {
    for (name, vision) in &VISIONS {
        for (i, a) in colors.iter().enumerate() {
            for b in &colors[i + 1..] {
                let d = distance(*a, *b, vision);
                assert!(d >= APART, "{what}, {name}: {a:?} and {b:?} are {d} apart");
            }
        }
    }
}

#[test]
fn the_colour_distance_confuses_red_and_green_like_the_eye() {
    let [(_, usual), _, (_, deuteranopia)] = &VISIONS;
    let (olive, rust) = ([0x8a, 0x8a, 0x00], [0xb8, 0x70, 0x10]);
    assert!(distance(olive, rust, usual) > 2.0 * distance(olive, rust, deuteranopia));
    // Black and white are 100 apart by definition of L*.
    assert!((distance([0; 3], [255; 3], usual) - 100.0).abs() < 0.1);
}

#[test]
fn the_five_meanings_stay_apart() {
    for theme in THEMES {
        assert_apart(&MEANINGS.map(|meaning| tone(theme, meaning)), "meanings");
    }
}

#[test]
fn a_second_visit_is_another_green_and_no_other_meaning() {
    for theme in THEMES {
        let seen_again = tone(theme, Tone::Revisit);
        for meaning in MEANINGS {
            assert_apart(&[seen_again, tone(theme, meaning)], "a second visit");
        }
        let ratio = contrast(seen_again, tone(theme, Tone::Paper));
        assert!(ratio >= 3.0, "{theme:?}: {ratio}");
    }
}

#[test]
fn the_way_back_is_the_lighter_green_in_both_themes() {
    for theme in THEMES {
        let [out, back] = [Tone::Outbound, Tone::Revisit].map(|pass| tone(theme, pass));
        let lightness = |color| lab(linear(color))[0];
        assert!(lightness(back) >= lightness(out) + APART, "{theme:?}");
        assert_apart(&[out, back], "the two passes");
        let ratio = contrast(out, tone(theme, Tone::Paper));
        assert!(ratio >= 3.0, "{theme:?}: {ratio}");
    }
}

#[test]
fn a_strained_edge_is_taken_for_no_meaning_and_is_not_faint() {
    for theme in THEMES {
        let strained = tone(theme, Tone::Strained);
        for other in MEANINGS.into_iter().chain([Tone::Outbound, Tone::Revisit]) {
            assert_apart(&[strained, tone(theme, other)], "a strained edge");
        }
        let ratio = contrast(strained, tone(theme, Tone::Paper));
        assert!(ratio >= 4.5, "{theme:?}: {ratio}");
    }
}

#[test]
fn the_series_stay_apart_and_are_taken_for_no_meaning() {
    for theme in THEMES {
        let series: [Rgb; 4] = core::array::from_fn(|n| tone(theme, Tone::Series(n as u8)));
        assert_apart(&series, "series");
        for color in series {
            for meaning in MEANINGS.into_iter().chain([Tone::Revisit, Tone::Ink]) {
                assert_apart(&[color, tone(theme, meaning)], "a series and a meaning");
            }
            // Also over cells that no beam has seen.
            for ground in [Tone::Paper, Tone::Unseen] {
                let ratio = contrast(color, tone(theme, ground));
                assert!(ratio >= 3.0, "{theme:?} {color:?} on {ground:?}: {ratio}");
            }
        }
    }
}

#[test]
fn the_seven_classes_stay_apart() {
    for theme in THEMES {
        let classes: [Rgb; 7] = core::array::from_fn(|k| cell(theme, RasterCell::Class(k as u8)));
        assert_apart(&classes, "classes");
    }
}

/// Marks are drawn on the areas of a picture of classes, and a picture fills in on paper.
#[test]
fn the_classes_below_marks_differ_from_meanings_and_paper() {
    /// Half of that: an area next to paper needs no name.
    const FROM_PAPER: f32 = 0.5 * APART;
    for theme in THEMES {
        for class in [0, 1, 2, 3, 4, 6] {
            let area = cell(theme, RasterCell::Class(class));
            for meaning in MEANINGS {
                assert_apart(&[area, tone(theme, meaning)], "a class and a meaning");
            }
            let [(_, usual), ..] = &VISIONS;
            let unknown = cell(theme, RasterCell::Unknown);
            for back in [tone(theme, Tone::Paper), unknown] {
                let d = distance(area, back, usual);
                assert!(
                    d >= FROM_PAPER,
                    "{theme:?} class {class}: {d} from {back:?}"
                );
            }
        }
    }
}

#[test]
fn lines_and_marks_have_a_contrast_of_three_to_one() {
    for theme in THEMES {
        let paper = tone(theme, Tone::Paper);
        // Ink draws walls and pairs.
        for meaning in MEANINGS.into_iter().chain([Tone::Ink]) {
            let ratio = contrast(tone(theme, meaning), paper);
            assert!(ratio >= 3.0, "{theme:?} {meaning:?}: {ratio}");
        }
    }
}

#[test]
fn text_has_a_contrast_of_four_and_a_half_to_one() {
    for theme in THEMES {
        let paper = tone(theme, Tone::Paper);
        for words in [Tone::Ink, Tone::Truth] {
            assert!(
                contrast(tone(theme, words), paper) >= 4.5,
                "{theme:?} {words:?}"
            );
        }
        for verdict in [Assessment::Good, Assessment::Bad, Assessment::Neutral] {
            let ratio = contrast(standing(theme, verdict), paper);
            assert!(ratio >= 4.5, "{theme:?} {verdict:?}: {ratio}");
        }
        for class in 0..7 {
            let back = cell(theme, RasterCell::Class(class));
            assert!(
                contrast(readable_on(back), back) >= 4.5,
                "{theme:?} class {class}"
            );
        }
    }
}

#[test]
fn lightness_rises_evenly_along_the_colour_map() {
    let lightness = |k: usize| lab(linear(level_color(k as f32 / 20.0)))[0];
    // Even steps would be (92 − 15)/20 = 3.85; the anchors are rounded to whole channels.
    for k in 1..=20 {
        let step = lightness(k) - lightness(k - 1);
        assert!((2.5..=5.2).contains(&step), "step {k} rises by {step}");
    }
}

#[test]
fn contrast_matches_its_definition() {
    assert!((contrast([0; 3], [255; 3]) - 21.0).abs() < 1e-3);
    assert_eq!(contrast([9, 9, 9], [9, 9, 9]), 1.0);
}
