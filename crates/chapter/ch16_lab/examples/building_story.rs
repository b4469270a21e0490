//! Prints the building with which the page of the reader's own robot opens.
//!
//! ```sh
//! cargo run --release -p ch16_lab --example building_story > web/page/building/building.json
//! ```

use ch16_lab::buildings::BuildingStory;

fn main() -> Result<(), serde_json::Error> {
    println!("{}", serde_json::to_string(&BuildingStory::for_page())?);
    Ok(())
}
