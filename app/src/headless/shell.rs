//! What a shell and a reader of manuals get of the command line, and what is said of a word that is
//! almost a command.
//!
//! In: the command line's own description. Out: scripts, pages, a sentence.

use super::command_line::Arguments;
use clap::error::ErrorKind;
use clap::{Command, CommandFactory, Parser};
use clap_complete::Shell;
use grainfall::output::{OutputError, write_file};
use grainfall::scene::{built_in, nearest};
use std::io::{self, Write};
use std::path::Path;

/// What the program is called.
const NAME: &str = "grainfall";

impl Arguments {
    /// What the program was called with; ends it where that is wrong or asks for help.
    pub fn of_the_process() -> Self {
        Self::try_parse().unwrap_or_else(|error| {
            let first = std::env::args().nth(1);
            match first.as_deref().and_then(misspelt_command) {
                Some(problem) => Self::command()
                    .error(ErrorKind::InvalidSubcommand, problem)
                    .exit(),
                None => error.exit(),
            }
        })
    }
}

/// What to say of `word` where it is neither a file nor a scene, and nearer to a command than to any
/// scene.
pub fn misspelt_command(word: &str) -> Option<String> {
    let program = Arguments::command();
    let commands: Vec<&str> = shown(&program).map(Command::get_name).collect();
    let scenes = built_in().iter().map(|scene| scene.name);
    let known: Vec<&str> = scenes.chain(commands.iter().copied()).collect();
    if known.contains(&word) || Path::new(word).exists() {
        return None;
    }
    let meant = nearest(word, &known).filter(|meant| commands.contains(meant))?;
    Some(format!(
        "`{word}` is neither a scene nor a command. Did you mean `{NAME} {meant}`?"
    ))
}

fn shown(program: &Command) -> impl Iterator<Item = &Command> {
    let has_a_page = |command: &&Command| !command.is_hide_set() && command.get_name() != "help";
    program.get_subcommands().filter(has_a_page)
}

/// Prints what `shell` needs to complete commands and options.
pub fn print_completions(shell: Shell) {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), NAME, &mut script);
    // There is nobody left to tell that nobody listens.
    drop(io::stdout().write_all(&script));
}

/// Writes a manual page for the program and for each command to `folder`.
///
/// # Errors
/// When one cannot be written.
pub fn write_manual(folder: &Path) -> Result<(), OutputError> {
    let mut program = Arguments::command();
    program.build();
    for command in [&program].into_iter().chain(shown(&program)) {
        let name = command.get_display_name().unwrap_or(NAME).to_owned();
        let path = folder.join(format!("{name}.1"));
        let page = clap_mangen::Man::new(command.clone()).title(name);
        write_file(&path, |file| page.render(&mut &mut *file))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn a_word_that_is_almost_a_command_is_answered_with_it() {
        let said = misspelt_command("swep").unwrap();
        assert!(said.contains("`grainfall sweep`"), "{said}");
        for word in [
            "sweep",
            "wet",
            "dry-r4",
            "Cargo.toml",
            "no-such-thing-at-all",
        ] {
            assert_eq!(misspelt_command(word), None, "{word}");
        }
    }

    #[test]
    fn every_command_has_its_manual_page_and_every_option_is_in_it() {
        let folder = tempfile::tempdir().unwrap();
        write_manual(folder.path()).unwrap();
        let page = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        assert!(page("grainfall.1").contains("no\\-render"));
        assert!(page("grainfall-sweep.1").contains("merge"));
        assert!(
            !folder.path().join("grainfall-bed.1").exists(),
            "a hidden command"
        );
    }
}
