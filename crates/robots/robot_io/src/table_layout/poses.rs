//! What the columns of a file of odometry are.

use super::{ColumnMeaning, Scaled, TableLayout, named, number, words};

impl TableLayout {
    /// The layout of a file of odometry with this start: by a header, by the form of `ros2 topic echo --csv`, or time, x, y
    /// and heading in rows of four numbers.
    #[must_use]
    pub fn of_poses(start: &[u8]) -> Option<Self> {
        let mut lines = start.split(|&byte| byte == b'\n' || byte == b'\r');
        let line = lines.find(|line| !line.trim_ascii().is_empty())?;
        let text = std::str::from_utf8(line).ok()?;
        let text = text.trim_start_matches('\u{feff}');
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

    /// With `theta` as the heading; `None` if the columns have no poses, or have ranges.
    fn of_pose_columns(mut columns: Vec<Scaled>) -> Option<Self> {
        use ColumnMeaning::{Angle, Heading, OrientationZ, Range, Ranges, Seconds, Time, X, Y};
        let has =
            |columns: &[Scaled], of: ColumnMeaning| columns.iter().any(|column| column.0 == of);
        if !has(&columns, Heading)
            && let Some(theta) = columns.iter_mut().find(|column| column.0 == Angle)
        {
            theta.0 = Heading;
        }
        let is_timed = has(&columns, Time) || has(&columns, Seconds);
        let is_turned = has(&columns, Heading) || has(&columns, OrientationZ);
        let is_pose = is_timed && is_turned && has(&columns, X) && has(&columns, Y);
        (is_pose && !has(&columns, Range) && !has(&columns, Ranges)).then(|| Self {
            columns,
            ..Self::default()
        })
    }
}
