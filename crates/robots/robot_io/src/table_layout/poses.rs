//! What the columns of a file of odometry are.

use super::{ColumnMeaning, Scaled, TableLayout, is_note, named, number, words};

impl TableLayout {
    /// The layout of a file of odometry with this start: by a header, by the form of `ros2 topic echo --csv`, or time, x, y
    /// and heading in rows of four numbers.
    #[must_use]
    pub fn of_poses(start: &[u8]) -> Option<Self> {
        let lines = Self::first_lines(start);
        let at = lines.iter().position(|line| !is_note(line))?;
        lines[..=at]
            .iter()
            .find_map(|text| Self::of_pose_line(text))
    }

    /// Whether the columns of a file are named, and are those of odometry.
    #[must_use]
    pub fn names_poses(start: &[u8]) -> bool {
        let lines = Self::first_lines(start);
        let is_named = |text: &&str| {
            let columns = Self::columns_of_header(text);
            columns.and_then(Self::of_pose_columns).is_some()
        };
        let header = lines.iter().position(|line| !is_note(line));
        let until = header.map_or(lines.len(), |at| at + 1);
        lines[..until].iter().any(is_named)
    }

    /// The layout of a file of odometry with this line before its rows, or as one of them.
    fn of_pose_line(text: &str) -> Option<Self> {
        let of_row = |names: &str| Self::of_named_poses(names).ok();
        let words: Vec<&str> = words(text).collect();
        match words.iter().map(|word| number(word)).collect::<Vec<_>>()[..] {
            [Some(_), Some(_), Some(_), Some(_)] => of_row("time,x,y,heading"),
            // ros2 topic echo --csv of nav_msgs/Odometry.
            [Some(_), Some(_), None, None, Some(_), ..] if words.len() > 11 => of_row(
                "sec,nanosec,frame_id,-,x,y,-,orientation.x,orientation.y,orientation.z,orientation.w",
            ),
            _ => Self::of_pose_columns(Self::columns_of_header(text)?),
        }
    }

    /// The columns of a file of odometry, by names.
    ///
    /// # Errors
    /// If a name is none of a column, or one that a pose needs is missing.
    pub fn of_named_poses(text: &str) -> Result<Self, String> {
        Self::of_pose_columns(named(text)?)
            .ok_or_else(|| "name time, x, y and heading of the odometry".to_owned())
    }

    /// `None` if the columns have no poses, or have ranges.
    fn of_pose_columns(columns: Vec<Scaled>) -> Option<Self> {
        use ColumnMeaning::{Heading, OrientationZ, Range, Ranges, Seconds, Time, X, Y};
        let layout = Self {
            columns,
            ..Self::default()
        };
        let has = |of| layout.has(of);
        let is_timed = has(Time) || has(Seconds);
        let is_turned = has(Heading) || has(OrientationZ);
        let is_pose = is_timed && is_turned && has(X) && has(Y);
        (is_pose && !has(Range) && !has(Ranges)).then_some(layout)
    }
}
