//! Files of a recording in a folder: by rosbag2's `metadata.yaml`, or the parts of `rosbag record --split`.

use crate::remark::{Part, Remark};

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
    ends_with(name, &[".mcap", ".db3"])
}

/// Whether a file name has one of these extensions, compressed or not.
fn ends_with(name: &str, extensions: &[&str]) -> bool {
    let lower = name.to_ascii_lowercase();
    let plain = PACKED
        .iter()
        .find_map(|end| lower.strip_suffix(end))
        .unwrap_or(&lower);
    extensions.iter().any(|end| plain.ends_with(end))
}

/// The files of a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InOrder {
    /// Indices in reading order.
    pub files: Vec<usize>,
    /// What differs from `metadata.yaml`.
    pub remarks: Vec<Remark>,
}

/// The files of a recording: those that `metadata` lists, else all ROS 2 files by name. Files that are not listed take
/// the places of as many that are missing, because they were renamed; if their number differs, all that are there are
/// read, and what is missing is said.
///
/// # Errors
/// The name of a listed file, if none is there and no other.
pub fn in_order(metadata: Option<&str>, names: &[String]) -> Result<InOrder, String> {
    let listed = metadata.map(listed_files).unwrap_or_default();
    let by_name = |files: &mut Vec<usize>| {
        // a_10.mcap follows a_9.mcap.
        files.sort_by_key(|&k| (names[k].len(), &names[k]));
    };
    let all = (0..names.len()).filter(|&k| is_recording(&names[k]));
    let mut all: Vec<usize> = all.collect();
    if all.is_empty() {
        all.extend((0..names.len()).filter(|&k| ends_with(&names[k], &[".bag"])));
    }
    by_name(&mut all);
    if listed.is_empty() {
        let remarks = missing_part(all.iter().map(|&k| names[k].as_str()));
        return Ok(InOrder {
            files: all,
            remarks: remarks.into_iter().collect(),
        });
    }
    let find = |listed: &String| {
        // Older versions list them relative to the parent folder, and compression changes their extension.
        let last = listed.rsplit('/').next().unwrap_or(listed);
        let is_it = |name: &String| {
            let end = name.strip_prefix(last);
            end.is_some_and(|end| end.is_empty() || PACKED.contains(&end))
        };
        names.iter().position(is_it)
    };
    let found: Vec<Option<usize>> = listed.iter().map(find).collect();
    let absent = listed
        .iter()
        .zip(&found)
        .filter(|(_, found)| found.is_none());
    let absent: Vec<String> = absent.map(|(name, _)| name.clone()).collect();
    let mut others = all;
    others.retain(|k| !found.contains(&Some(*k)));
    if absent.is_empty() {
        others.clear();
    } else if others.is_empty() && absent.len() == listed.len() {
        return Err(absent[0].clone());
    }
    let name_all = |files: &[usize]| crate::lines::listed(files.iter().map(|&k| names[k].clone()));
    let absent_names = crate::lines::listed(absent.iter().cloned());
    let mut remarks = Vec::new();
    let is_renamed = !absent.is_empty() && others.len() == absent.len();
    let files: Vec<usize> = if is_renamed {
        remarks.push(Remark::mended(
            Part::File,
            format!(
                "{METADATA} lists {absent_names}, which is not there; {} is read in its place",
                name_all(&others)
            ),
        ));
        let mut others = others.into_iter();
        let replaced = found
            .into_iter()
            .map(|found| found.or_else(|| others.next()));
        replaced.flatten().collect()
    } else {
        if !absent.is_empty() {
            remarks.push(Remark::wrong(
                Part::File,
                format!(
                    "a part of the recording is missing: {METADATA} lists {absent_names}, which is not there; copy it into the folder"
                ),
            ));
        }
        found.into_iter().flatten().chain(others).collect()
    };
    Ok(InOrder { files, remarks })
}

/// A remark on the first number that is missing among those at the end of the parts' names.
fn missing_part<'a>(names: impl Iterator<Item = &'a str>) -> Option<Remark> {
    let number = |name: &str| {
        let stem = name.split_once('.').map_or(name, |(stem, _)| stem);
        let digits = stem.len() - stem.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        let is_part = stem[..stem.len() - digits].ends_with(['_', '-']);
        stem[stem.len() - digits..]
            .parse::<u32>()
            .ok()
            .filter(|_| is_part)
    };
    let numbered: Option<Vec<(u32, &str)>> =
        names.map(|name| Some((number(name)?, name))).collect();
    let numbered = numbered?;
    // Numbers that jump everywhere are dates, not parts.
    let follows = |two: &&[(u32, &str)]| two[0].0.checked_add(1) == Some(two[1].0);
    let pairs = numbered.windows(2);
    let follow = pairs.clone().filter(follows).count();
    let mut breaks = pairs.filter(|two| !follows(two));
    let gap = breaks.next()?;
    let [(last, before), (next, after)] = [gap[0], gap[1]];
    let is_one = breaks.next().is_none() && next > last && (follow > 0 || next - last == 2);
    is_one.then(|| {
        Remark::wrong(
            Part::File,
            format!(
                "a part of the recording is missing: {after} follows {before}; copy the parts between them into the folder"
            ),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_split_bag_are_in_order_and_a_missing_one_is_named() {
        let ordered = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            let order = in_order(None, &names).unwrap();
            let said: Vec<String> = order
                .remarks
                .into_iter()
                .map(|remark| remark.text)
                .collect();
            (order.files, said.join(" "))
        };
        let parts = ["run_10.bag", "run_9.bag", "notes.txt", "run_8.bag"];
        assert_eq!(ordered(&parts), (vec![3, 1, 0], String::new()));
        let (files, said) = ordered(&["run_2023-11-14-22_0.bag", "run_2023-11-14-23_2.bag"]);
        assert_eq!(files, [0, 1]);
        assert!(
            said.contains("run_2023-11-14-23_2.bag follows run_2023-11-14-22_0.bag"),
            "{said}"
        );
        for dates in [
            ["a_20231114.bag", "a_20240102.bag"],
            ["first.bag", "second.bag"],
        ] {
            assert_eq!(ordered(&dates).1, "");
        }
        // A recording that was converted is not read twice.
        assert_eq!(ordered(&["run_0.bag", "run_0.mcap"]).0, [1]);
    }

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
        let files = |listed, names| in_order(listed, names).map(|order| order.files);
        assert_eq!(files(Some(listed), &names), Ok(vec![1, 3]));
        assert_eq!(files(Some("version: 5"), &names), Ok(vec![1, 0, 3]));
        assert_eq!(files(None, &names[2..3]), Ok(vec![]));
        let absent = "  relative_file_paths:\n    - a_3.db3\n";
        assert_eq!(files(Some(absent), &names[2..3]), Err("a_3.db3".to_owned()));
    }

    #[test]
    fn renamed_files_take_their_places_and_missing_ones_are_named() {
        let names = ["mine.db3", "a_1.db3", "metadata.yaml"].map(str::to_owned);
        let two = "  relative_file_paths:\n    - a_0.db3\n    - a_1.db3\n";
        let renamed = in_order(Some(two), &names).unwrap();
        assert_eq!(renamed.files, [0, 1]);
        assert_eq!(
            renamed.remarks[0].text,
            "metadata.yaml lists a_0.db3, which is not there; mine.db3 is read in its place"
        );
        let missing = in_order(Some(two), &names[1..]).unwrap();
        assert_eq!(missing.files, [0]);
        let text = &missing.remarks[0].text;
        assert!(
            text.contains("lists a_0.db3, which is not there; copy it"),
            "{text}"
        );
    }

    #[test]
    fn the_files_of_a_recording_come_in_their_order() {
        let text = "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n    - a_0.db3\n    - \"a_1.db3\"\n  message_count: 3\n  files:\n    - path: x\n";
        assert_eq!(listed_files(text), ["a_0.db3", "a_1.db3"]);
        assert_eq!(listed_files("version: 5"), Vec::<String>::new());
        assert!(is_recording("a.db3.zstd") && is_recording("A.MCAP") && !is_recording("a.yaml"));
    }
}
