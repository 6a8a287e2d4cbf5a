//! Where an exported file came from: program and version, scene and seed, and the state it shows.
//!
//! In: a scene and a state. Out: the same few words for every kind of exported file: text chunks of
//! a PNG, a description in an SVG, a comment in XML, and beside tables a file that says it of them
//! ([`super::write_metadata`]).

use super::VERSION;
use crate::scene::Scene;
use crate::world::World;
use std::fmt;

/// What is said of a state that has no hash.
const RECORDED: &str = "out of the files of a run, in 32 bits";

/// Where a file came from.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    scene: String,
    seed: u64,
    state: Option<State>,
    /// Of a picture of two runs: what the right one differs in, and the hash of its state.
    beside: Option<(String, String)>,
}

/// A state that a file shows.
#[derive(Clone, Debug, PartialEq)]
struct State {
    time: f64,
    step: u64,
    /// None of a state out of files that round it.
    hash: Option<String>,
}

impl Provenance {
    /// From `world`, a state of `scene`.
    pub fn of(scene: &Scene, world: &World) -> Self {
        Self::at(
            scene,
            world.time(),
            world.clock.step,
            world.hash().to_string(),
        )
    }

    /// From the state of `scene` with this `hash`, at `time` [s] after `step` steps.
    pub fn at(scene: &Scene, time: f64, step: u64, hash: String) -> Self {
        Self {
            state: Some(State {
                time,
                step,
                hash: Some(hash),
            }),
            ..Self::of_scene(scene)
        }
    }

    /// From `world`, a state of a run of `scene` as its files hold it, in 32 bits: a hash would be
    /// that of no state of the run.
    pub fn recorded(scene: &Scene, world: &World) -> Self {
        Self {
            state: Some(State {
                time: world.time(),
                step: world.clock.step,
                hash: None,
            }),
            ..Self::of_scene(scene)
        }
    }

    /// From `scene`, of no one state.
    pub fn of_scene(scene: &Scene) -> Self {
        Self {
            scene: printable(&scene.title),
            seed: scene.seed,
            state: None,
            beside: None,
        }
    }

    /// The same with a state of another run to the right, in which `change` is different.
    #[must_use]
    pub fn beside(mut self, change: String, world: &World) -> Self {
        self.beside = Some((change, world.hash().to_string()));
        self
    }

    /// The same by name and value. The first two names are those that PNG files have for it.
    pub fn entries(&self) -> Vec<(&'static str, String)> {
        let mut entries = vec![
            ("Software", format!("Grainfall {VERSION}")),
            ("Title", self.scene.clone()),
            ("Seed", self.seed.to_string()),
        ];
        if let Some(state) = &self.state {
            entries.push(("Time", format!("{:?} s", state.time)));
            entries.push(("Step", state.step.to_string()));
            entries.push(match &state.hash {
                Some(hash) => ("State hash", hash.clone()),
                None => ("State", RECORDED.to_owned()),
            });
        }
        if let Some((change, hash)) = &self.beside {
            entries.push(("Right half", change.clone()));
            entries.push(("State hash of the right half", hash.clone()));
        }
        entries
    }

    /// What the scene is called.
    pub fn title(&self) -> &str {
        &self.scene
    }

    /// Simulated time of the state [s]; none of no one state.
    pub fn time(&self) -> Option<f64> {
        self.state.as_ref().map(|state| state.time)
    }

    /// `xml` with a comment that says so, behind the tag that opens its first element: there are
    /// readers that find out what a file is by what stands first.
    pub fn in_xml(&self, xml: &str) -> String {
        let mut tags = xml.match_indices('<').map(|(at, _)| at);
        let element = tags.find(|at| !xml[*at..].starts_with("<?"));
        let end = element.and_then(|at| Some(at + xml[at..].find('>')? + 1));
        let (head, body) = xml.split_at(end.unwrap_or(0));
        // Two hyphens would end the comment, and three hold two of them.
        let mut text = self.to_string();
        while text.contains("--") {
            text = text.replace("--", "- -");
        }
        format!("{head}\n<!-- {text} -->\n{}", body.trim_start())
    }

    /// `svg` with a description that says so, which readers for the blind speak as well.
    pub fn in_svg(&self, svg: &str) -> String {
        let text = escaped(&self.to_string());
        let svg = printable(svg);
        let start = svg.find("<svg").unwrap_or(0);
        let inside = svg[start..].find('>').map_or(0, |end| start + end + 1);
        let (head, body) = svg.split_at(inside);
        format!("{head}\n<desc>{text}</desc>{body}")
    }
}

impl fmt::Display for Provenance {
    /// `Grainfall 0.1.0, “A small drum”, seed 1, t = 1.25 s, step 60000, state 0123…`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "Grainfall {VERSION}, “{}”, seed {}",
            self.scene, self.seed
        )?;
        if let Some(State { time, step, hash }) = &self.state {
            let state = hash.as_deref().unwrap_or(RECORDED);
            write!(f, ", t = {time:?} s, step {step}, state {state}")?;
        }
        match &self.beside {
            Some((change, hash)) => write!(f, ", beside it with {change}: state {hash}"),
            None => Ok(()),
        }
    }
}

/// `text` with what cannot be printed written out, as `\u{1b}`: no XML may hold it, and terminals
/// obey it. Ends of lines and tabs stay.
pub fn printable(text: &str) -> String {
    let mut printable = String::with_capacity(text.len());
    for c in text.chars() {
        if is_unprintable(c) {
            printable.extend(c.escape_unicode());
        } else {
            printable.push(c);
        }
    }
    printable
}

/// Control characters, what turns the direction of the text after it, and what is no character.
pub(super) fn is_unprintable(c: char) -> bool {
    let is_control = c.is_control() && !matches!(c, '\n' | '\t');
    let turns = matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    is_control || turns || matches!(c, '\u{fffe}' | '\u{ffff}')
}

/// `text` as it stands in XML.
fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn provenance() -> Provenance {
        let mut scene = Scene::open("bouncing-grain").unwrap();
        scene.title = "a --> b <c> & d".into();
        Provenance::at(&scene, 0.5, 20, "0a".into())
    }

    #[test]
    fn xml_stays_xml_whatever_a_scene_is_called() {
        let declared = provenance().in_xml("<?xml version=\"1.0\"?>\n<a b=\"c\">\n<d/>\n</a>\n");
        let opening = "<?xml version=\"1.0\"?>\n<a b=\"c\">\n<!-- Grainfall";
        assert!(declared.starts_with(opening), "{declared}");
        assert!(declared.ends_with("-->\n<d/>\n</a>\n") && declared.matches("--").count() == 2);
        let bare = provenance().in_xml("<a/>");
        assert!(bare.starts_with("<a/>\n<!-- ") && bare.ends_with("-->\n"));
        let svg = provenance().in_svg("<?xml version=\"1.0\"?><svg width=\"3\">\n<g/></svg>");
        assert!(svg.contains("<svg width=\"3\">\n<desc>Grainfall"), "{svg}");
        assert!(svg.contains("a --&gt; b &lt;c&gt; &amp; d”, seed"), "{svg}");
        assert!(svg.ends_with("</desc>\n<g/></svg>"), "{svg}");
    }

    #[test]
    fn no_title_ends_a_comment_or_reaches_a_reader_as_a_control_character() {
        let mut scene = Scene::open("bouncing-grain").unwrap();
        for title in [
            "a---b",
            "a-----",
            "--------b",
            "\u{1b}[31m\u{7}\0 -\u{202e}- \r",
        ] {
            scene.title = title.into();
            let xml = Provenance::of_scene(&scene).in_xml("<a/>");
            let inside = &xml["<a/>\n<!--".len()..xml.find("-->").unwrap()];
            assert!(!inside.contains("--") && !inside.ends_with('-'), "{xml}");
            assert!(!xml.contains(is_unprintable), "{xml:?}");
            let svg = Provenance::of_scene(&scene).in_svg("<svg>\u{8}</svg>");
            assert!(!svg.contains(is_unprintable), "{svg:?}");
        }
    }

    #[test]
    fn state_is_told_to_the_last_digit() {
        let entries = provenance().entries();
        assert_eq!(
            entries[3..],
            [
                ("Time", "0.5 s".to_owned()),
                ("Step", "20".to_owned()),
                ("State hash", "0a".to_owned()),
            ]
        );
    }
}
