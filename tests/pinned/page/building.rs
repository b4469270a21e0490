//! The building with which the page of the reader's own robot opens.

use ch16_lab::buildings::BuildingStory;

#[test]
fn the_building_of_the_page_is_what_the_estimator_computes() {
    let computed = serde_json::to_string(&BuildingStory::for_page()).expect("plain numbers");
    let committed = include_str!("../../../web/page/building/building.json");
    assert_eq!(
        computed,
        committed.trim_end(),
        "run: cargo run --release -p ch16_lab --example building_story > web/page/building/building.json"
    );
}
