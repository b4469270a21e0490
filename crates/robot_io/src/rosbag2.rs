//! Files of a rosbag2 folder, by its `metadata.yaml`.

/// Name of the file that describes a recording.
pub const METADATA: &str = "metadata.yaml";

/// File name extensions of compressed recordings.
const PACKED: [&str; 3] = [".zstd", ".zst", ".gz"];

/// The file names of a recording in order, as `metadata.yaml` lists them.
///
/// Reads only `relative_file_paths`, in which rosbag2 writes one name per line.
#[must_use]
pub fn listed_files(metadata: &str) -> Vec<String> {
    let mut lines = metadata.lines();
    let mut names = Vec::new();
    let begins = |line: &str| line.trim_start().starts_with("relative_file_paths:");
    if lines.by_ref().any(begins) {
        for line in lines {
            let Some(name) = line.trim_start().strip_prefix("- ") else {
                break;
            };
            let name = name.trim().trim_matches(['"', '\'']);
            names.push(name.to_owned());
        }
    }
    names
}

/// Whether a file name is that of a ROS 2 recording, compressed or not.
#[must_use]
pub fn is_recording(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let plain = PACKED
        .iter()
        .find_map(|end| lower.strip_suffix(end))
        .unwrap_or(&lower);
    [".mcap", ".db3"].iter().any(|end| plain.ends_with(end))
}

/// Indices of the files of a recording in reading order: those that `metadata` lists, else all ROS 2 files by name.
///
/// # Errors
/// The name of a listed file that is missing.
pub fn in_order(metadata: Option<&str>, names: &[String]) -> Result<Vec<usize>, String> {
    let listed = metadata.map(listed_files).unwrap_or_default();
    if listed.is_empty() {
        let all = 0..names.len();
        let mut found: Vec<usize> = all.filter(|&k| is_recording(&names[k])).collect();
        // a_10.mcap follows a_9.mcap.
        found.sort_by_key(|&k| (names[k].len(), &names[k]));
        return Ok(found);
    }
    let find = |listed: String| {
        // Older versions list them relative to the parent folder, and compression changes their extension.
        let last = listed.rsplit('/').next().unwrap_or(&listed);
        let is_it = |name: &String| {
            let end = name.strip_prefix(last);
            end.is_some_and(|end| end.is_empty() || PACKED.contains(&end))
        };
        names.iter().position(is_it).ok_or(listed)
    };
    listed.into_iter().map(find).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recording_of_several_files_is_read_in_the_order_of_its_metadata_or_its_numbers() {
        let names = [
            "a_10.db3",
            "a_9.db3",
            "b.txt",
            "a_2.db3.zstd",
            "metadata.yaml",
        ];
        let names = names.map(str::to_owned);
        let listed = "  relative_file_paths:\n    - bag/a_9.db3\n    - bag/a_2.db3\n";
        assert_eq!(in_order(Some(listed), &names), Ok(vec![1, 3]));
        assert_eq!(in_order(Some("version: 5"), &names), Ok(vec![1, 0, 3]));
        assert_eq!(in_order(None, &names[2..3]), Ok(vec![]));
        let absent = "  relative_file_paths:\n    - a_3.db3\n";
        assert_eq!(in_order(Some(absent), &names), Err("a_3.db3".to_owned()));
    }

    #[test]
    fn the_files_of_a_recording_come_in_their_order() {
        let text = "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n    - a_0.db3\n    - \"a_1.db3\"\n  message_count: 3\n  files:\n    - path: x\n";
        assert_eq!(listed_files(text), ["a_0.db3", "a_1.db3"]);
        assert_eq!(listed_files("version: 5"), Vec::<String>::new());
        assert!(is_recording("a.db3.zstd") && is_recording("A.MCAP") && !is_recording("a.yaml"));
    }
}
