//! The parts of the suite that can be run alone.

/// A part of the suite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Piece {
    /// `cargo fmt --check`.
    Format,
    /// The licences of all crates and npm packages.
    Licences,
    /// Everything native: compiled and linted in one pass, then tested.
    Native,
    /// Lints of what only WebAssembly compiles.
    Lints,
    /// Counted instructions against the recorded ones.
    Counts,
    /// The site as it is published, and the types of its element.
    Site,
    /// The module in Node.
    Node,
    /// The site in Chromium.
    Browser,
}

impl Piece {
    /// All of them, in the order in which they run.
    pub const ALL: [Self; 8] = [
        Self::Format,
        Self::Licences,
        Self::Native,
        Self::Lints,
        Self::Counts,
        Self::Site,
        Self::Node,
        Self::Browser,
    ];

    /// What `--quick` runs: nothing that builds the site.
    pub const QUICK: [Self; 4] = [Self::Format, Self::Licences, Self::Native, Self::Lints];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Format => "format",
            Self::Licences => "licences",
            Self::Native => "native",
            Self::Lints => "lints",
            Self::Counts => "counts",
            Self::Site => "site",
            Self::Node => "node",
            Self::Browser => "browser",
        }
    }

    /// The piece of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|piece| piece.name() == name)
    }

    /// Whether wasm-bindgen, Node, npm packages and their kin must be there.
    pub fn needs_the_site(self) -> bool {
        matches!(
            self,
            Self::Licences | Self::Lints | Self::Site | Self::Node | Self::Browser
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_piece_is_found_by_its_name() {
        for piece in Piece::ALL {
            assert_eq!(Piece::named(piece.name()), Some(piece));
        }
        assert_eq!(Piece::named("everything"), None);
    }
}
