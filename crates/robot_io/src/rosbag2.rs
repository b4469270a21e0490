//! A folder of rosbag2: which files it has, by its `metadata.yaml`.

/// The names of the files of a recording, in their order, as `metadata.yaml` lists them.
///
/// rosbag2 writes one name on each line of `relative_file_paths`; that is all that is read.
#[must_use]
pub fn files_of(metadata: &str) -> Vec<String> {
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

/// Whether the name of a file is that of a recording of ROS 2, packed or not.
#[must_use]
pub fn is_recording(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let plain = [".zstd", ".zst", ".gz"]
        .iter()
        .find_map(|end| lower.strip_suffix(end))
        .unwrap_or(&lower);
    [".mcap", ".db3"].iter().any(|end| plain.ends_with(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_of_a_recording_come_in_their_order() {
        let text = "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n    - a_0.db3\n    - \"a_1.db3\"\n  message_count: 3\n  files:\n    - path: x\n";
        assert_eq!(files_of(text), ["a_0.db3", "a_1.db3"]);
        assert_eq!(files_of("version: 5"), Vec::<String>::new());
        assert!(is_recording("a.db3.zstd") && is_recording("A.MCAP") && !is_recording("a.yaml"));
    }
}
