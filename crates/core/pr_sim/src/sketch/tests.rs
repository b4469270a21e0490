use proptest::prelude::*;

use super::*;

fn courses() -> [Course; 5] {
    [
        Course::apartment(),
        Course::ring(),
        Course::twin_rooms(),
        Course::bare_corridor(),
        Course::round_hall(),
    ]
}

#[test]
fn a_world_is_the_same_course_by_file_and_by_link() {
    for course in courses() {
        let sketch = Sketch::from_course(&course);
        let drawn = sketch.course().expect("a built-in world can be driven");
        // Half a centimetre along each axis: the corners of the round hall are not on the grid.
        let near = |a: Point2<f64>, b: Point2<f64>| (a - b).norm() < 0.0071;
        for (wall, known) in drawn.world().walls().iter().zip(course.world().walls()) {
            assert!(near(wall.start, known.start) && near(wall.end, known.end));
        }
        assert_eq!(drawn.world().walls().len(), course.world().walls().len());
        let by_file = Course::from_json(sketch.to_json().as_bytes()).expect("our own file");
        assert_eq!(by_file, drawn, "by the file");
        let by_link = Sketch::from_text(&sketch.to_text()).expect("our own text");
        assert_eq!(by_link, sketch, "by the link");
        assert_eq!(Sketch::from_course(&drawn), sketch, "and round again");
    }
    assert_eq!(
        Sketch::from_course(&Course::apartment()).course(),
        Ok(Course::apartment())
    );
}

#[test]
fn the_apartment_takes_a_tenth_of_what_a_link_may() {
    // The commission allows 2 kB.
    let text = Sketch::from_course(&Course::apartment()).to_text();
    assert!(text.len() < 200, "{} characters: {text}", text.len());
    let letters = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_';
    assert!(text.bytes().all(letters), "{text}");
}

#[test]
fn a_text_that_lost_or_changed_a_character_is_rejected() {
    let text = Sketch::from_course(&Course::twin_rooms()).to_text();
    for at in 0..text.len() {
        let (before, after) = (&text[..at], &text[at + 1..]);
        for damaged in [format!("{before}{after}"), before.to_owned()] {
            assert_eq!(Sketch::from_text(&damaged), Err(SketchError::Damaged));
        }
        let other = if text.as_bytes()[at] == b'A' {
            'B'
        } else {
            'A'
        };
        let changed = format!("{before}{other}{after}");
        assert_eq!(Sketch::from_text(&changed), Err(SketchError::Damaged));
    }
}

#[test]
fn huge_counts_far_places_and_newer_versions_are_rejected_by_name() {
    let rejection = |numbers: &[i32]| Sketch::from_text(&text::written(numbers)).unwrap_err();
    assert_eq!(rejection(&[2, 0]), SketchError::Newer);
    assert_eq!(rejection(&[1, 0, 0, 0, 0, 51]), SketchError::TooLarge);
    assert_eq!(rejection(&[1, 0, 0, 0, 0, 0, 2001]), SketchError::TooLarge);
    assert_eq!(rejection(&[1, 0, 0, 10_001, 0]), SketchError::TooLarge);
    for (numbers, what) in [
        (&[1, 0, 360, 0, 0, 0, 0][..], "a heading beyond a turn"),
        (&[1, 1, 0, 0, 0, 0, 0], "a turn at no waypoint"),
        (&[1, 0, 0, 0, 0, 0, 1, 5, 5, 0, 0], "a wall without length"),
        (&[1, 0, 0, 0, 0, 0, 0, 0], "a number too many"),
        (&[1, 0, 0, 0, 0, -1], "fewer than none"),
        (&[1, 0, 0, 0, 0, 0, i32::MAX - 1], "more than memory holds"),
    ] {
        let error = rejection(numbers);
        assert_ne!(error, SketchError::Newer, "{what}");
        assert!(!error.to_string().contains('\n'), "{what}");
    }
}

fn place() -> impl Strategy<Value = PlaceCm> {
    let most = 100 * limits::COORDINATE_M as i32;
    [-most..=most, -most..=most]
}

fn sketch() -> impl Strategy<Value = Sketch> {
    let walls = prop::collection::vec([place(), place()], 0..60);
    let way_points = prop::collection::vec(place(), 0..20);
    (walls, way_points, place(), 0..360, any::<u8>()).prop_map(
        |(walls, way_points_cm, start_cm, heading_deg, turn)| Sketch {
            walls_cm: walls.into_iter().filter(|[a, b]| a != b).collect(),
            turn: usize::from(turn).checked_rem(way_points_cm.len()),
            way_points_cm,
            start_cm,
            heading_deg,
        },
    )
}

proptest! {
    #[test]
    fn any_sketch_comes_back_from_its_text(sketch in sketch()) {
        let text = sketch.to_text();
        prop_assert_eq!(Sketch::from_text(&text), Ok(sketch));
    }

    #[test]
    fn no_text_does_harm_and_what_is_read_writes_back(text in "[A-Za-z0-9_-]{0,40}") {
        if let Ok(sketch) = Sketch::from_text(&text) {
            prop_assert_eq!(sketch.to_text(), text);
        }
    }

    #[test]
    fn a_sketch_that_can_be_driven_is_the_same_course_from_its_file(sketch in sketch()) {
        let by_file = Course::from_json(sketch.to_json().as_bytes());
        match sketch.course() {
            Ok(course) => prop_assert_eq!(by_file, Ok(course)),
            Err(_) => prop_assert!(by_file.is_err()),
        }
    }
}
