//! The options of a log as arguments.

use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, error::ErrorKind};
use robot_io::log::{LogOption, LogOptions};

/// The first `COUNT` of [`LogOption::ALL`] as arguments.
#[derive(Clone, Debug, Default)]
pub struct LogArgs<const COUNT: usize>(pub LogOptions);

/// Without those on odometry.
pub type TopicArgs = LogArgs<9>;
/// Those on a log of one robot.
pub type OneRobotArgs = LogArgs<11>;
/// All.
pub type AllLogArgs = LogArgs<{ LogOption::ALL.len() }>;

impl<const COUNT: usize> LogArgs<COUNT> {
    fn options() -> impl Iterator<Item = LogOption> {
        LogOption::ALL.into_iter().take(COUNT)
    }
}

impl<const COUNT: usize> Args for LogArgs<COUNT> {
    fn augment_args(command: Command) -> Command {
        let argument = |option: LogOption| {
            let name = option.name();
            let argument = Arg::new(name).long(name).help(option.about());
            let argument = match option {
                LogOption::Odometry => argument.default_value("check"),
                LogOption::NoOdometry => argument.conflicts_with(LogOption::Odometry.name()),
                LogOption::AllRobots => {
                    argument.conflicts_with_all(LogOption::TOPICS.map(LogOption::name))
                }
                _ => argument,
            };
            let Some(value_name) = option.value_name() else {
                return argument.action(ArgAction::SetTrue);
            };
            let check = move |text: &str| {
                let set = LogOptions::default().with(option, text);
                set.map(|_| text.to_owned())
            };
            let argument = argument.value_name(value_name).value_parser(check);
            argument.allow_hyphen_values(!LogOption::TOPICS.contains(&option))
        };
        command.args(Self::options().map(argument))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<const COUNT: usize> FromArgMatches for LogArgs<COUNT> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let given = Self::options().filter_map(|option| {
            let name = option.name();
            if option.value_name().is_none() {
                return matches.get_flag(name).then_some((name, ""));
            }
            let text: &String = matches.get_one(name)?;
            Some((name, text.as_str()))
        });
        let options = LogOptions::read(given);
        options
            .map(Self)
            .map_err(|problem| clap::Error::raw(ErrorKind::ValueValidation, problem))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
