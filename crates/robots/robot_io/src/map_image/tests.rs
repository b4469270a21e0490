//! Images and YAML files of small maps.

use core::f64::consts::TAU;

use ch16_slam2d::scan::LaserScan;
use pr_grid::MAX_TILED_CELLS;

use super::*;

/// A robot in a room of 4 m × 3 m whose lower left corner is at (1, 2), scanned five times.
fn room() -> MapImage {
    let mut map = MapBuilder::new(0.1);
    let step = TAU / 720.0;
    for x in [2.0, 2.5, 3.0, 3.5, 4.0] {
        let (left, right, down, up) = (x - 1.0, 5.0 - x, 1.5, 1.5);
        let ranges_m = (0..720).map(|beam| {
            let (sin, cos) = math::sin_cos(-3.0 + f64::from(beam) * step);
            let along = if cos > 0.0 { right / cos } else { -left / cos };
            let across = if sin > 0.0 { up / sin } else { -down / sin };
            along.min(across)
        });
        let scan = LaserScan {
            first_angle_rad: -3.0,
            angle_step_rad: step,
            ranges_m: ranges_m.collect(),
            ..LaserScan::default()
        };
        map.add(&SE2::new(x, 3.5, 0.0), &scan).unwrap();
    }
    map.finish().unwrap()
}

/// The pixel that Nav2 reads at a position.
fn pixel(map: &MapImage, pgm: &[u8], x: f64, y: f64) -> u8 {
    let column = ((x - map.origin_m[0]) / map.cell_m).floor() as usize;
    let row = ((y - map.origin_m[1]) / map.cell_m).floor() as usize;
    let pixels = &pgm[pgm.len() - map.width * map.height..];
    pixels[(map.height - 1 - row) * map.width + column]
}

#[test]
fn walls_are_black_floors_white_and_what_lies_beyond_is_unknown() {
    let map = room();
    let mut pgm = Vec::new();
    map.write_pgm(&mut pgm).unwrap();
    assert!(pgm.starts_with(format!("P5\n{} {}\n255\n", map.width, map.height).as_bytes()));
    for (x, y) in [(1.5, 2.5), (3.0, 3.5), (4.5, 4.5)] {
        assert_eq!(pixel(&map, &pgm, x, y), 254, "{x} {y}");
    }
    // A wall lies on the border of two cells: one of them is black.
    for (x, y, dx, dy) in [
        (1.0, 3.45, 0.04, 0.0),
        (5.0, 3.45, 0.04, 0.0),
        (2.95, 2.0, 0.0, 0.04),
    ] {
        let sides = [-1.0, 1.0].map(|side| pixel(&map, &pgm, x + side * dx, y + side * dy));
        assert!(sides.contains(&0), "{x} {y}: {sides:?}");
    }
    assert_eq!(pixel(&map, &pgm, 0.85, 1.85), 205);
    let [occupied, free, unknown] = map.counts();
    // 14 m of wall in cells of 0.1 m, one or two thick; 12 m² of floor.
    assert!((120..=300).contains(&occupied), "{occupied}");
    assert!((1000..=1200).contains(&free), "{free}");
    assert_eq!(occupied + free + unknown, map.width * map.height);
}

#[test]
fn unknown_is_transparent_in_scale_and_every_pixel_reads_back() {
    let map = room();
    let mut bytes = Vec::new();
    map.write_png(&mut bytes, MapMode::Scale).unwrap();
    let mut reader = png::Decoder::new(io::Cursor::new(&bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(
        (info.width as usize, info.height as usize),
        (map.width, map.height)
    );
    for (pixel, log_odds) in pixels.chunks(2).zip(map.log_odds()) {
        assert_eq!(pixel[1] == 0, log_odds == 0.0);
        if log_odds != 0.0 {
            // Probability that Nav2 computes from lightness: within half a step of 255.
            let p = 1.0 - f64::from(pixel[0]) / 255.0;
            let expected = 1.0 / (1.0 + math::exp(-log_odds));
            assert!((p - expected).abs() < 0.007, "{p} {expected}");
        }
    }
}

#[test]
fn the_yaml_names_what_the_map_server_needs() {
    let map = room();
    let yaml = map.yaml("map.pgm", MapMode::Trinary);
    let [x, y] = map.origin_m;
    assert_eq!(
        yaml,
        format!(
            "image: map.pgm\nmode: trinary\nresolution: 0.1\norigin: [{x}, {y}, 0]\nnegate: 0\n\
             occupied_thresh: 0.65\nfree_thresh: 0.196\n"
        )
    );
    // Unknown is 205, between the two thresholds.
    let unknown = 1.0 - 205.0 / 255.0;
    assert!(unknown > FREE_PIXEL && unknown < OCCUPIED);
}

#[test]
fn an_empty_map_is_rejected() {
    let mut map = MapBuilder::new(0.05);
    map.add(&SE2::identity(), &LaserScan::default()).unwrap();
    assert_eq!(map.finish().unwrap_err(), MapError::Nothing);
}

#[test]
fn beams_without_a_return_mark_free_space_by_option() {
    // An open hall: a wall behind the robot, nothing in front within 5 m.
    let scan = LaserScan {
        first_angle_rad: -TAU / 2.0,
        angle_step_rad: TAU / 360.0,
        range_max_m: 5.0,
        ranges_m: (0..360)
            .map(|beam| if (90..270).contains(&beam) { 5.0 } else { 2.0 })
            .collect(),
        ..LaserScan::default()
    };
    let counts = |map: MapBuilder| {
        let mut map = map;
        map.add(&SE2::identity(), &scan).unwrap();
        map.finish().unwrap().counts()
    };
    let [occupied, free, _] = counts(MapBuilder::new(0.1));
    let [occupied_too, more, _] = counts(MapBuilder::new(0.1).with_no_return(NoReturn::Free));
    assert_eq!(occupied, occupied_too);
    // Half a disk of 5 m in cells of 0.1 m, to a tenth for its rim.
    let half_disk = 0.5 * TAU / 2.0 * 50.0 * 50.0;
    let gained = (more - free) as f64;
    assert!((gained / half_disk - 1.0).abs() < 0.1, "{gained}");
    // The map extends to the limit, and no cell is occupied there.
    assert!(more > 3 * free);
}

#[test]
fn a_place_that_is_too_large_has_the_finest_map_that_fits_and_says_so() {
    let wall = LaserScan {
        first_angle_rad: -1.5,
        angle_step_rad: 0.01,
        ranges_m: vec![10.0; 300],
        ..LaserScan::default()
    };
    let build = |most: usize, far_m: f64| {
        finest_map(0.1, |cell_m| {
            let mut map = MapBuilder::new(cell_m).with_most_cells(most);
            for x in [0.0, far_m] {
                map.add(&SE2::new(x, 0.0, 0.0), &wall)?;
            }
            map.finish()
        })
    };
    // 20 m × 20 m around either pose: 16 tiles or more of 64 × 64 cells of 0.1 m, 4 of 0.2 m.
    let whole = build(MAX_TILED_CELLS, 100.0).unwrap();
    assert_eq!((whole.cell_m, whole.coarser_than(0.1)), (0.1, None));
    let coarse = build(20 * 64 * 64, 100.0).unwrap();
    assert_eq!(coarse.cell_m, 0.2);
    let said = coarse.coarser_than(0.1).unwrap();
    assert!(said.starts_with("the map has cells of 0.2 m"), "{said}");
    // Two places 10,000 km apart: 2e8 × 200 cells of 0.1 m in an image.
    let apart = build(MAX_TILED_CELLS, 1e7).unwrap();
    assert!(apart.cell_m > 0.1 && apart.width as u64 * apart.height as u64 <= MAX_PIXELS);
    assert_eq!(
        build(MAX_TILED_CELLS, 1e300).unwrap_err().to_string(),
        "the map needs more than 67108864 cells of 102.4 m"
    );
}
