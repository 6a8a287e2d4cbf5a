//! What lies between grains or starts at them: force chains, liquid bridges, velocity arrows, drawn
//! to scale.
//!
//! In: the world shown and what of it is to be seen. Out: one draw of round bars, and what their
//! colour, thickness and length mean. A bar of a force goes from centre to centre, coloured and as
//! thick as the force is large; one that pulls has a waist. A bridge is a meniscus between the grains' surfaces that holds
//! its volume. An arrow tapers to its tip.

use crate::simulation::DrawnIn;
use crate::view::colour::{linear, quantile, round_up, stride};
use crate::view::grain_buffer::CutPlanes;
use crate::view::quads::{self, quads};
use crate::view::shown_worlds::{ShownWorlds, ViewSystems, layers};
use crate::view::view_settings::{ColourMap, Cut, Legend, LinkScales, ViewSettings};
use bevy::asset::{RenderAssetUsages, load_internal_asset, uuid_handle};
use bevy::camera::visibility::NoFrustumCulling;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::ShaderRef;
use bevy::tasks::{ComputeTaskPool, ParallelSlice};
use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use grainfall::lab::Half;
use grainfall::world::{Contact, Partner, World};
use std::f64::consts::PI;

const SHADER: Handle<Shader> = uuid_handle!("c1a9b0de-5f35-4a25-8a53-71f5a2f0cb21");

/// What a bar stands for; `as usize` gives its place in the palette, where that is no force, whose
/// colour tells how large it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LinkKind {
    /// A force that pushes.
    Push,
    /// A force that pulls.
    Pull,
    /// A bridge.
    Liquid,
    /// A velocity.
    Velocity,
}

impl LinkKind {
    const ALL: [Self; 4] = [Self::Push, Self::Pull, Self::Liquid, Self::Velocity];

    /// sRGB.
    pub(super) fn colour(self) -> [u8; 3] {
        match self {
            Self::Push | Self::Pull => FORCE_MAP.colour(1.0),
            Self::Liquid => [0x46, 0x9F, 0xE0],
            Self::Velocity => [0xE8, 0xEC, 0xF2],
        }
    }

    /// How strongly the light is mirrored.
    fn gloss(self) -> f32 {
        match self {
            Self::Liquid => 0.7,
            Self::Push | Self::Pull | Self::Velocity => 0.12,
        }
    }
}

/// The colours of forces, from none to the reference: none of the maps that grains have at first.
pub(super) const FORCE_MAP: ColourMap = ColourMap::Plasma;
/// Steps of these colours: what of a byte [`LinkKind`] leaves.
const LEVELS: usize = 64;

/// Radius of the bar of the reference force, and of the root of an arrow, in mean radii of grains.
const FORCE_RADIUS: f64 = 0.3;
const ARROW_RADIUS: f64 = 0.16;
/// Length of the arrow of the reference speed, in mean radii of grains.
const ARROW_LENGTH: f64 = 4.0;
/// Contacts whose bars one thread makes at a time.
const PART: usize = 16_384;
/// No bar is thicker than that of this many reference forces.
const LARGEST: f64 = 2.0;
/// Forces and speeds below this share of the reference are not drawn.
const SMALLEST: f64 = 0.01;
/// Radius of a waist over that of its bar.
const WAIST: f64 = 0.35;
/// Radius of a meniscus at its middle over that of the rings where it meets the grains.
const MENISCUS_WAIST: f64 = 0.8;

/// Adds the links' material, their entity and what keeps it up to date.
pub(super) fn plugin(app: &mut App) {
    load_internal_asset!(
        app,
        SHADER,
        "../../assets/shaders/links.wgsl",
        Shader::from_wgsl
    );
    app.add_plugins(MaterialPlugin::<LinkMaterial>::default())
        .add_systems(Startup, spawn)
        .add_systems(Update, update.in_set(ViewSystems::Draw));
}

#[derive(Asset, TypePath, AsBindGroup, Clone)]
struct LinkMaterial {
    #[storage(0, read_only)]
    links: Handle<ShaderBuffer>,
    #[uniform(1)]
    palette: LinkColours,
}

/// The linear colour of each [`LinkKind`], and how it shines.
#[derive(Clone, Copy, ShaderType)]
struct LinkColours {
    colours: [Vec4; LinkKind::ALL.len()],
    /// Of forces by how large they are.
    forces: [Vec4; LEVELS],
}

impl Material for LinkMaterial {
    fn vertex_shader() -> ShaderRef {
        SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _pipeline: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        _key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        quads::specialize(descriptor, layout)
    }
}

/// A bar as the shader reads it, small: a picture of the tallest columns has a quarter of a
/// million.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
struct Link {
    from: [f32; 3],
    /// The larger of the radii at both ends.
    radius: f32,
    to: [f32; 3],
    /// Radii at both ends in 255ths of the larger one; the [`LinkKind`] in two bits with the place of
    /// its colour in six; and how much thinner the middle is than straight sides would make it, in
    /// 255ths.
    shape: [u8; 4],
}

/// The whole number nearest to `x`, which is none below zero; `round` is a call on older processors.
fn nearest(x: f64) -> u8 {
    (x + 0.5) as u8
}

impl Link {
    fn new(ends: [DVec3; 2], radii: [f64; 2], kind: LinkKind) -> Self {
        let radius = radii[0].max(radii[1]);
        let share = |r: f64| nearest(255.0 * r / radius);
        Self {
            from: ends[0].as_vec3().to_array(),
            radius: radius as f32,
            to: ends[1].as_vec3().to_array(),
            shape: [share(radii[0]), share(radii[1]), kind as u8, 0],
        }
    }

    /// It with a middle of this `waist` over its radius; from there it widens as a parabola.
    fn with_waist(mut self, waist: f64) -> Self {
        self.shape[3] = nearest(255.0 * (1.0 - waist));
        self
    }

    /// It in the colour at this `share` of the reference force.
    fn coloured(mut self, share: f64) -> Self {
        let level = nearest(share.clamp(0.0, 1.0) * (LEVELS - 1) as f64);
        self.shape[2] |= level << 2;
        self
    }

    fn middle(&self) -> Vec3 {
        0.5 * (Vec3::from(self.from) + Vec3::from(self.to))
    }
}

/// The entity that draws all links of one half of the picture.
#[derive(Component, Default)]
struct Links {
    /// Capacity of its mesh and its buffer, in bars.
    room: usize,
}

fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<LinkMaterial>>,
) {
    let colours = LinkKind::ALL.map(|kind| Vec3::from(linear(kind.colour())).extend(kind.gloss()));
    let level = |k: usize| FORCE_MAP.colour(k as f64 / (LEVELS - 1) as f64);
    let gloss = LinkKind::Push.gloss();
    let forces = std::array::from_fn(|k| Vec3::from(linear(level(k))).extend(gloss));
    let palette = LinkColours { colours, forces };
    for half in Half::ALL {
        commands.spawn((
            DrawnIn(half),
            layers(half),
            Links::default(),
            Mesh3d(meshes.add(quads(&[0]))),
            MeshMaterial3d(materials.add(LinkMaterial {
                links: Handle::default(),
                palette,
            })),
            Visibility::Hidden,
            NoFrustumCulling,
        ));
    }
}

/// What decides the links beside the world.
type LinkChoice = (bool, bool, bool, Option<Cut>);

/// Redraws the links when the worlds shown or what is to be seen of them have changed.
fn update(
    shown: Res<ShownWorlds>,
    mut settings: ResMut<ViewSettings>,
    mut last: Local<Option<LinkChoice>>,
    mut halves: Query<(
        &DrawnIn,
        &mut Links,
        &mut Mesh3d,
        &MeshMaterial3d<LinkMaterial>,
        &mut Visibility,
    )>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<LinkMaterial>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    let choice = (
        settings.show_forces,
        settings.show_bridges,
        settings.show_velocities,
        settings.cut,
    );
    if !shown.is_changed() && *last == Some(choice) {
        return;
    }
    *last = Some(choice);
    let worlds: Vec<&World> = shown.worlds().collect();
    let scales = scales(&worlds, &settings);
    if settings.link_scales != scales {
        settings.link_scales = scales;
    }
    for (&DrawnIn(half), mut links, mut mesh, material, mut visibility) in &mut halves {
        let world = shown.half(half);
        let parts = world.map_or_else(Vec::new, |world| bars(world, &settings));
        let count = parts.iter().map(Vec::len).sum();
        if count == 0 {
            visibility.set_if_neq(Visibility::Hidden);
            continue;
        }
        visibility.set_if_neq(Visibility::Inherited);
        let room = room_for(count, links.room);
        let bytes = together(&parts, room);
        let handle = materials.get(&material.0).map(|m| m.links.clone());
        if room == links.room
            && let Some(mut buffer) = handle.and_then(|handle| buffers.get_mut(&handle))
        {
            buffer.data = Some(bytes);
        } else if let Some(mut material) = materials.get_mut(&material.0) {
            let all: Vec<u32> = (0..room as u32).collect();
            mesh.0 = meshes.add(quads(&all));
            let buffer = ShaderBuffer::new(&bytes, RenderAssetUsages::RENDER_WORLD);
            material.links = buffers.add(buffer);
            links.room = room;
        }
    }
}

/// Capacity of the mesh and the buffer for `count` bars: the present `room` while that is neither
/// too small nor much too large.
fn room_for(count: usize, room: usize) -> usize {
    if (count..=2 * count).contains(&room) {
        room
    } else {
        count + count / 4
    }
}

/// What the colours of forces mean, where `scales` have them.
pub(super) fn force_legend(scales: &LinkScales) -> Option<Legend> {
    let max = scales.force?;
    Some(Legend {
        title: "Force",
        min: 0.0,
        max,
        unit: "N",
        is_log: false,
    })
}

/// What the bars that are asked for mean, the same in all `worlds`.
fn scales(worlds: &[&World], settings: &ViewSettings) -> LinkScales {
    let before = &settings.link_scales;
    let mut scales = LinkScales::default();
    let Some(radius) = worlds.first().map(|world| mean_radius(world)) else {
        return scales;
    };
    if settings.show_forces {
        let count = worlds.iter().map(|world| world.contacts.len()).sum();
        let contacts = worlds.iter().flat_map(|world| &world.contacts);
        let force = |contact: &Contact| contact.force.length();
        let reference = reference(contacts.step_by(stride(count)).map(force));
        scales.force = Some(steady(reference, before.force));
        scales.thickness = 2.0 * FORCE_RADIUS * radius;
    }
    if settings.show_bridges {
        scales.liquid = worlds.iter().any(|world| world.wetting().is_some());
    }
    if settings.show_velocities {
        let count = worlds.iter().map(|world| world.grains.len()).sum();
        let velocities = worlds.iter().flat_map(|world| &world.grains.velocity);
        let speed = |v: &DVec3| v.length();
        let reference = reference(velocities.step_by(stride(count)).map(speed));
        scales.speed = Some(steady(reference, before.speed));
        scales.length = ARROW_LENGTH * radius;
    }
    scales
}

/// The bars of `world`, as large as the scales say, in several lists.
fn bars(world: &World, settings: &ViewSettings) -> Vec<Vec<Link>> {
    let radius = mean_radius(world);
    let mut parts = Vec::new();
    if let Some(reference) = settings.link_scales.force {
        parts = force_bars(world, reference, radius);
    }
    if settings.show_bridges {
        let bridge = |contact: &Contact| bridge_bar(world, contact);
        parts.push(world.contacts.iter().filter_map(bridge).collect());
    }
    if let Some(reference) = settings.link_scales.speed {
        parts.push(arrows(world, reference, radius));
    }
    if settings.cut.is_some() {
        let cut = CutPlanes::of(settings.cut);
        for part in &mut parts {
            part.retain(|link| !cut.take_away(link.middle()));
        }
    }
    parts
}

/// The bytes of all bars of these `parts`, and of some without a size that fill the `room`.
fn together(parts: &[Vec<Link>], room: usize) -> Vec<u8> {
    let length = room * size_of::<Link>();
    let mut bytes = Vec::with_capacity(length);
    for part in parts {
        bytes.extend_from_slice(bytemuck::cast_slice(part));
    }
    bytes.resize(length, 0);
    bytes
}

/// The bars of all forces, of many by several threads.
fn force_bars(world: &World, reference: f64, radius: f64) -> Vec<Vec<Link>> {
    let bars = |_: usize, contacts: &[Contact]| {
        let mut part = Vec::with_capacity(contacts.len());
        for contact in contacts {
            push_force(world, contact, [reference, radius], &mut part);
        }
        part
    };
    if world.contacts.len() <= PART {
        return vec![bars(0, &world.contacts)];
    }
    let pool = ComputeTaskPool::get();
    world.contacts.par_chunk_map(pool, PART, bars)
}

/// Appends the bars of a contact's force where the bar of the `reference` is as thick as grains of
/// this `radius` have it.
fn push_force(
    world: &World,
    contact: &Contact,
    [reference, radius]: [f64; 2],
    bars: &mut Vec<Link>,
) {
    let share = contact.force.length() / reference;
    if share.is_nan() || share < SMALLEST {
        return;
    }
    let [from, to] = ends(world, contact);
    let thick = FORCE_RADIUS * radius * share.min(LARGEST);
    if contact.force.dot(to - from) <= 0.0 {
        let bar = Link::new([from, to], [thick; 2], LinkKind::Push);
        bars.push(bar.coloured(share));
        return;
    }
    let (middle, thin) = (0.5 * (from + to), WAIST * thick);
    for (ends, radii) in [
        ([from, middle], [thick, thin]),
        ([middle, to], [thin, thick]),
    ] {
        let bar = Link::new(ends, radii, LinkKind::Pull);
        bars.push(bar.coloured(share));
    }
}

/// The meniscus of a contact; none where it has no bridge.
fn bridge_bar(world: &World, contact: &Contact) -> Option<Link> {
    let (Some(bridge), Partner::Grain(j)) = (&contact.bridge, contact.partner) else {
        return None;
    };
    let grains = &world.grains;
    let (i, j) = (contact.grain as usize, j as usize);
    let radii = [grains.radius[i], grains.radius[j]];
    let [from, to] = ends(world, contact);
    let normal = (to - from).normalize_or_zero();
    let gap = (to - from).length() - radii[0] - radii[1];
    let ring = meniscus_ring(bridge.volume, gap, radii);
    // From where it meets one sphere to where it meets the other.
    let inside = |r: f64| (r * r - (ring * ring).min(r * r)).sqrt();
    let ends = [
        from + normal * inside(radii[0]),
        to - normal * inside(radii[1]),
    ];
    let bar = Link::new(ends, [ring; 2], LinkKind::Liquid);
    Some(bar.with_waist(MENISCUS_WAIST))
}

fn arrows(world: &World, reference: f64, radius: f64) -> Vec<Link> {
    let arrow = |(x, v): (&DVec3, &DVec3)| {
        let tip = *x + *v * (ARROW_LENGTH * radius / reference);
        let radii = [ARROW_RADIUS * radius, 0.0];
        let is_seen = v.length() > SMALLEST * reference;
        is_seen.then(|| Link::new([*x, tip], radii, LinkKind::Velocity))
    };
    let grains = world.grains.position.iter().zip(&world.grains.velocity);
    grains.filter_map(arrow).collect()
}

/// The two centres, or the centre and the nearest point of the wall [m].
fn ends(world: &World, contact: &Contact) -> [DVec3; 2] {
    let from = world.grains.position[contact.grain as usize];
    let to = match contact.partner {
        Partner::Grain(j) => world.grains.position[j as usize],
        Partner::Wall(w) => {
            let (distance, towards) = world.container.walls[w as usize].surface.distance(from);
            from + distance * towards
        }
    };
    [from, to]
}

/// Radius of the rings where a meniscus that holds `volume` [m³] meets two spheres of these `radii`
/// at this `gap` [m]. Its own radius goes as a parabola from ring to ring, with its waist between;
/// with the spheres' parabolas and the square q of the ring's radius it holds
/// `V = π q (B D + q (B/2 − 1/4)/r*)`, B being the mean square of its radius over that of the ring.
fn meniscus_ring(volume: f64, gap: f64, radii: [f64; 2]) -> f64 {
    let effective = radii[0] * radii[1] / (radii[0] + radii[1]);
    let (waist, rest) = (MENISCUS_WAIST, 1.0 - MENISCUS_WAIST);
    let mean_square = waist * waist + 2.0 / 3.0 * waist * rest + 0.2 * rest * rest;
    let (square, linear) = ((0.5 * mean_square - 0.25) / effective, mean_square * gap);
    let root = (linear * linear + 4.0 * square * volume / PI).sqrt();
    ((root - linear) / (2.0 * square)).max(0.0).sqrt()
}

fn mean_radius(world: &World) -> f64 {
    let radii = &world.grains.radius;
    radii.iter().sum::<f64>() / radii.len().max(1) as f64
}

/// A round number that all but a fiftieth of the numbers above zero stay below.
fn reference(numbers: impl Iterator<Item = f64>) -> f64 {
    let mut numbers: Vec<f64> = numbers.filter(|x| x.is_finite() && *x > 0.0).collect();
    quantile(&mut numbers, 0.98).map_or(1.0, round_up)
}

/// `before` while it suits, so that bars do not jump from frame to frame.
fn steady(reference: f64, before: Option<f64>) -> f64 {
    before
        .filter(|before| (0.3..=1.0).contains(&(reference / before)))
        .unwrap_or(reference)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meniscus_holds_its_volume_between_two_spheres() {
        // Slices along the axis from ring to ring, less the caps of the spheres beyond the rings.
        let (radii, gap, volume) = ([3e-3_f64, 2e-3], 1e-4, 4e-10);
        let ring = meniscus_ring(volume, gap, radii);
        let sagitta = radii.map(|r| r - (r * r - ring * ring).sqrt());
        let height = gap + sagitta[0] + sagitta[1];
        let slices = 20_000;
        let slice = |k: i32| {
            let v = (f64::from(k) + 0.5) / f64::from(slices) * 2.0 - 1.0;
            let radius = ring * (MENISCUS_WAIST + (1.0 - MENISCUS_WAIST) * v * v);
            PI * radius * radius * height / f64::from(slices)
        };
        let cap = |k: usize| PI * sagitta[k].powi(2) * (radii[k] - sagitta[k] / 3.0);
        let found = (0..slices).map(slice).sum::<f64>() - cap(0) - cap(1);
        // Parabolas for circles: (ρ/r)²/8 of the caps, which are twice the liquid.
        assert!((found / volume - 1.0).abs() < 0.05, "{}", found / volume);
        // Grains that overlap have a wider one, and no liquid none.
        assert!(meniscus_ring(volume, -1e-5, radii) > ring);
        assert_eq!(meniscus_ring(0.0, gap, radii), 0.0);
    }

    #[test]
    fn room_is_kept_while_it_suits() {
        assert_eq!(room_for(100, 0), 125);
        assert_eq!(room_for(125, 125), 125);
        assert_eq!(room_for(126, 125), 157);
        assert_eq!(room_for(63, 125), 125);
        assert_eq!(room_for(62, 125), 77);
        assert_eq!(room_for(1, 0), 1);
    }

    #[test]
    fn scale_keeps_still_while_it_suits() {
        assert_eq!(steady(0.5, Some(1.0)), 1.0);
        assert_eq!(steady(0.2, Some(1.0)), 0.2);
        assert_eq!(steady(2.0, Some(1.0)), 2.0);
        assert_eq!(reference([0.0, f64::NAN].into_iter()), 1.0);
    }

    #[test]
    fn a_bar_is_as_thick_as_its_force_and_a_pull_has_a_waist() {
        let mut world = crate::view::test_worlds::grains_in_a_row(2);
        let contact = |force: DVec3| Contact {
            grain: 0,
            partner: Partner::Grain(1),
            spring: DVec3::ZERO,
            stiffness: 0.0,
            rolling: DVec3::ZERO,
            force,
            touching: true,
            bridge: None,
        };
        let along = (world.grains.position[1] - world.grains.position[0]).normalize();
        let bars = |force: DVec3, world: &mut World| {
            let mut bars = Vec::new();
            push_force(world, &contact(force), [1.0, 1e-3], &mut bars);
            bars
        };
        let [push] = bars(-0.5 * along, &mut world)[..] else {
            panic!("a push is one bar");
        };
        // Half the reference force: the colour in the middle.
        assert_eq!((push.radius, push.shape), (0.15e-3, [255, 255, 32 << 2, 0]));
        let pull = bars(0.5 * along, &mut world);
        assert_eq!(pull.len(), 2);
        // A waist of 0.35 in 255ths.
        assert_eq!(pull[0].shape, [255, 89, LinkKind::Pull as u8 | 32 << 2, 0]);
        assert_eq!(pull[1].shape, [89, 255, LinkKind::Pull as u8 | 32 << 2, 0]);
        assert!(bars(DVec3::splat(f64::NAN), &mut world).is_empty());
    }
}
