//! Claims about the registry of parameters: each has one row, and what files held before is still
//! read.

use grainfall::parameters::{
    Kind, NameKind, Parameter, Settings, Value, Values, entries, live_parameters, start_parameters,
    table_of_keys,
};
use grainfall::run::{Command, ScriptedCommand, StampedCommand};
use grainfall::scene::{Scene, SceneGrains, built_in};
use grainfall::solver::advise;
use grainfall::world::build;
use std::collections::BTreeMap;

fn as_coded() -> Value {
    Parameter::BridgeLaw.row().parse("as-coded").unwrap()
}

#[test]
fn keys_lead_to_their_parameter_and_back() {
    let mut keys = BTreeMap::new();
    for entry in entries() {
        let parameter = (entry.of)(["glass", "drum"]);
        assert_eq!(parameter.row().key, entry.row.key);
        assert_eq!(parameter.name_kind(), entry.name_kind);
        let key = parameter.to_string();
        assert!(Parameter::of_key(&key).contains(&parameter), "{key}");
        assert_eq!(key.split('.').count(), 1 + entry.name_kind.count());
        *keys.entry(entry.row.key).or_insert(0) += 1;
    }
    // The radius of a column and that of grains that fill a container: no scene has both.
    let shared: Vec<_> = keys.iter().filter(|(_, count)| **count > 1).collect();
    assert_eq!(shared, [(&"radius", &2)]);
}

#[test]
fn every_row_says_what_it_is_and_can_be_read_and_written() {
    let scene = Scene::open("small-drum").unwrap();
    for entry in entries() {
        let (key, row) = (entry.key(), entry.row);
        assert!(!(row.name)(&scene).is_empty(), "{key} has no name");
        assert!(
            row.description.ends_with('.'),
            "{key} says not what it does"
        );
        assert!(row.in_scene.is_some() || row.in_world.is_some(), "{key}");
        if row.is_live() {
            assert!(!(row.equation)(&scene).is_empty(), "{key} has no equation");
        }
        let limits = row.limits.is_some();
        let counts = matches!(row.kind, Kind::Count | Kind::Choice(_));
        assert!(limits || counts, "{key} has no limits");
    }
}

#[test]
fn scenes_offer_ranges_within_hard_limits_that_hold_their_own_values() {
    for known in built_in() {
        let scene = Scene::open(known.name).unwrap();
        if matches!(scene.grains, SceneGrains::Voronoi(_)) {
            continue; // Thousands of cells: their parameters are those of the boxes and drums tested.
        }
        let world = build(&scene, advise(&scene).time_step);
        let live = live_parameters(&scene, &world);
        assert!(!live.is_empty());
        for info in live.iter().chain(&start_parameters(&scene)) {
            let Values::Range(range) = &info.values else {
                continue;
            };
            if matches!(info.parameter, Parameter::Share(_)) {
                continue; // As near the scene's as whole grains come, which may be beyond the end.
            }
            let value = info.default.number();
            assert!(
                range.contains(&value),
                "{} in {}",
                info.parameter,
                known.name
            );
            if let Some(limits) = info.row().limits {
                let inside = *range.start() >= limits.least && *range.end() <= limits.most;
                assert!(inside, "{} in {}", info.parameter, known.name);
            }
        }
    }
}

#[test]
fn start_values_are_written_as_they_are() {
    let mut scene = Scene::open("small-drum").unwrap();
    for info in start_parameters(&scene.clone()) {
        let Values::Range(range) = &info.values else {
            panic!("{} is a number", info.parameter);
        };
        // A little more than it was: a third of a unit in a place that text rounds.
        let more = info.default.number() * (1.0 + 1.0 / 3e15);
        let value = info.row().value(more.clamp(*range.start(), *range.end()));
        info.parameter.state(value, &mut scene).unwrap();
        assert_eq!(
            info.parameter.stated(&scene),
            Some(value),
            "{}",
            info.parameter
        );
    }
}

#[test]
fn choices_are_words_in_text_files_and_numbers_where_hashes_are_made() {
    let command = Command::Set {
        parameter: Parameter::BridgeLaw,
        value: as_coded(),
    };
    let json = serde_json::to_string(&command).unwrap();
    assert_eq!(
        json,
        r#"{"Set":{"parameter":"bridge-law","value":"as-coded"}}"#
    );
    assert_eq!(serde_json::from_str::<Command>(&json).unwrap(), command);
    // As it was when the choice was a number: the variant, the key with its length, an f64.
    let mut bytes = vec![10, 10];
    bytes.extend_from_slice(b"bridge-law");
    bytes.extend_from_slice(&1.0_f64.to_le_bytes());
    assert_eq!(postcard::to_stdvec(&command).unwrap(), bytes);
    assert_eq!(postcard::from_bytes::<Command>(&bytes).unwrap(), command);
}

#[test]
fn numbers_that_stood_for_choices_are_read_and_others_refused() {
    let text = |value: &str| format!(r#"{{"Set":{{"parameter":"bridge-law","value":{value}}}}}"#);
    for (old, key) in [
        ("0.0", "as-printed"),
        ("1.0", "as-coded"),
        ("1", "as-coded"),
    ] {
        let read: Command = serde_json::from_str(&text(old)).unwrap();
        let value = Parameter::BridgeLaw.row().parse(key).unwrap();
        let parameter = Parameter::BridgeLaw;
        assert_eq!(read, Command::Set { parameter, value });
    }
    for wrong in ["0.37", "3.0", "\"as-told\"", "\"full\""] {
        let message = serde_json::from_str::<Command>(&text(wrong))
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("as-printed") && message.contains("as-coded"),
            "{message}"
        );
    }
    let entry = r#"(step: 3, command: Set(parameter: "bridge-law", value: 0.37))"#;
    let options =
        ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    let message = options
        .from_str::<ScriptedCommand>(entry)
        .unwrap_err()
        .to_string();
    assert!(message.contains("cannot be 0.37"), "{message}");
    let entry = entry.replace("0.37", "\"as-coded\"");
    let read: ScriptedCommand = options.from_str(&entry).unwrap();
    assert_eq!(
        serde_json::to_value(&read.command).unwrap()["Set"]["value"],
        "as-coded"
    );
}

#[test]
fn numbers_keep_their_form_in_files() {
    let stamped = StampedCommand {
        step: 7,
        time: 0.5,
        command: Command::Set {
            parameter: Parameter::Friction("glass".into(), "drum".into()),
            value: Value::Number(0.1),
        },
    };
    let json = serde_json::to_string(&stamped).unwrap();
    let expected = r#"{"step":7,"time":0.5,"command":{"Set":{"parameter":"friction.glass.drum","value":0.1}}}"#;
    assert_eq!(json, expected);
    assert_eq!(
        serde_json::from_str::<StampedCommand>(&json).unwrap(),
        stamped
    );
}

#[test]
fn what_does_nothing_in_a_scene_is_not_offered() {
    let scene = Scene::parse(
        "one.ron",
        r#"(
            title: "One grain on a floor",
            materials: { "glass": (), "steel": (), "gold": () },
            container: Planes([(point: (0, 0, 0), normal: (0, 1, 0), material: "steel")]),
            grains: List([(position: (0, 0.01, 0), radius: 0.005, material: "glass")]),
        )"#,
    )
    .unwrap();
    let settings = Settings::of(&scene);
    let keys: Vec<&str> = settings.list().iter().map(|s| s.key.as_str()).collect();
    assert!(keys.contains(&"restitution.glass.steel"));
    assert!(keys.contains(&"density.glass") && keys.contains(&"youngs-modulus.steel"));
    for idle in [
        "restitution.glass.glass",
        "friction.glass.gold",
        "youngs-modulus.gold",
        "density.steel",
        "count",
        "drum-speed",
        "viscosity",
    ] {
        assert!(!keys.contains(&idle), "{idle} is offered");
    }
    // A record in which it was set is still read.
    let world = build(&scene, 1e-6);
    let live = live_parameters(&scene, &world);
    let idle = Parameter::Restitution("glass".into(), "glass".into());
    assert!(live.iter().any(|info| info.parameter == idle && !info.acts));
}

#[test]
fn settings_list_values_in_the_unit_of_people_and_in_si() {
    let settings = Settings::of(&Scene::open("small-drum").unwrap());
    let text = settings.to_string();
    assert!(
        text.contains("-10 to 10 rpm") && text.contains("at the next start"),
        "{text}"
    );
    let json = serde_json::to_value(settings.list()).unwrap();
    let all = json.as_array().unwrap();
    let speed = all
        .iter()
        .find(|setting| setting["key"] == "drum-speed")
        .unwrap();
    assert_eq!(speed["unit"], "rad/s");
    assert_eq!(speed["is_live"], true);
}

#[test]
fn the_guide_to_scenes_lists_every_key_as_the_registry_has_it() {
    let guide = include_str!("../../scenes/README.md");
    let table = table_of_keys();
    assert!(
        guide.contains(&table),
        "scenes/README.md should hold this table:\n{table}"
    );
}

#[test]
fn pairs_are_named_in_the_order_of_the_scene() {
    let world = build(&Scene::open("small-drum").unwrap(), 1e-6);
    let swapped = Parameter::Friction("drum".into(), "glass".into());
    let own = Parameter::Friction("glass".into(), "drum".into());
    assert_eq!(swapped.canonical(&world.materials), own);
    assert_eq!(own.name_kind(), NameKind::Pair);
}

#[test]
fn named_values_are_those_of_the_scenes_own_materials() {
    let names = |scene: &str, pair: [&str; 2]| {
        let scene = Scene::open(scene).unwrap();
        let world = build(&scene, advise(&scene).time_step);
        let [a, b] = pair.map(str::to_owned);
        let friction = Parameter::Friction(a, b);
        let list = live_parameters(&scene, &world);
        let info = list.iter().find(|info| info.parameter == friction).unwrap();
        let presets = info.presets(&scene).into_iter();
        let names = presets.map(|preset| (preset.name.to_owned(), preset.value));
        names.collect::<Vec<_>>()
    };
    let own = names("two-frictions-drum", ["rough", "rough"]);
    let expected = [("none", 0.0), ("smooth", 0.1), ("rough", 0.8)];
    assert_eq!(own, expected.map(|(name, value)| (name.to_owned(), value)));
    let glass = names("small-drum", ["glass", "glass"]);
    assert!(glass.contains(&("dry glass".to_owned(), 0.4)));
}

/// Each of the two alone is refused: a hundred thousand seconds have a million outputs at most.
#[test]
fn values_that_hold_together_only_all_at_once_are_taken_all_at_once() {
    let open = || Scene::open("small-drum").unwrap();
    let both = [("duration", "1000000s"), ("output-interval", "1s")];
    assert!(open().set(both[0].0, both[0].1).is_err());
    for order in [both, [both[1], both[0]]] {
        let mut scene = open();
        scene.set_all(&order).unwrap();
        assert_eq!((scene.duration, scene.output_interval), (1e6, 1.0));
    }
    let mut scene = open();
    let refused = scene.set_all(&[("duration", "1000000s"), ("output-interval", "0.5s")]);
    assert!(refused.is_err());
    assert_eq!(scene, open(), "nothing is changed by what is refused");
}
