//! The ring: four corridors around a block of rooms.

use crate::world::{Wall, World, rectangle};

impl World {
    /// A ring of corridors, 1.4 m wide, around a block of five rooms: 12 m × 9 m like the Apartment.
    ///
    /// Every room has one door, so the corridors are the only path around the block. All corridors
    /// differ in the positions of their doors and of the pillars on their outer walls.
    #[must_use]
    pub fn ring() -> Self {
        let walls = vec![
            Wall::horizontal(0.0, 0.0, 12.0),
            Wall::horizontal(9.0, 0.0, 12.0),
            Wall::vertical(0.0, 0.0, 9.0),
            Wall::vertical(12.0, 0.0, 9.0),
            // The block, south side, with two doors.
            Wall::horizontal(1.4, 1.4, 3.2),
            Wall::horizontal(1.4, 4.1, 7.9),
            Wall::horizontal(1.4, 8.8, 10.6),
            // North side.
            Wall::horizontal(7.6, 1.4, 5.2),
            Wall::horizontal(7.6, 6.1, 10.6),
            // West side.
            Wall::vertical(1.4, 1.4, 5.0),
            Wall::vertical(1.4, 5.9, 7.6),
            // East side.
            Wall::vertical(10.6, 1.4, 3.0),
            Wall::vertical(10.6, 3.9, 7.6),
            // Between the rooms.
            Wall::horizontal(4.6, 1.4, 10.6),
            Wall::vertical(6.0, 1.4, 4.6),
            Wall::vertical(9.4, 1.4, 4.6),
            Wall::vertical(4.4, 4.6, 7.6),
            // Pillars on the outer walls.
            Wall::vertical(2.9, 0.0, 0.3),
            Wall::vertical(5.6, 0.0, 0.35),
            Wall::vertical(9.7, 0.0, 0.3),
            Wall::vertical(3.1, 8.7, 9.0),
            Wall::vertical(7.2, 8.65, 9.0),
            Wall::vertical(9.0, 8.7, 9.0),
            Wall::horizontal(3.6, 0.0, 0.3),
            Wall::horizontal(6.7, 0.0, 0.35),
            Wall::horizontal(2.4, 11.7, 12.0),
            Wall::horizontal(5.3, 11.65, 12.0),
        ];
        Self::new(rectangle(0.0, 0.0, 12.0, 9.0), walls)
    }
}
