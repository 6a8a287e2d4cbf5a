//! What all grains have in common in the picture, whatever their shape: place, colour, shadow, and
//! what is cut away.
//!
//! In: the world shown and how to colour it. Out: one buffer with an entry per grain, rewritten
//! when the world or the colours change, one with the shadow of each, rewritten whenever a round of
//! them is done, and the legend. Who draws a shape finds its grains in these buffers by their index,
//! so that nothing is done per grain on the processor but filling them.

use crate::view::colour;
use crate::view::occlusion::{Occlusion, Shadows};
use crate::view::shown_worlds::{ShownWorlds, ViewSystems};
use crate::view::view_settings::{ColourBy, ColourMap, ColourRange, Cut, Legend, ViewSettings};
use bevy::asset::{RenderAssetUsages, load_internal_asset, uuid_handle};
use bevy::prelude::*;
use bevy::render::render_resource::ShaderType;
use bevy::render::storage::ShaderBuffer;
use bytemuck::{Pod, Zeroable};
use grainfall::lab::Half;
use grainfall::world::{Polyhedra, Polyhedron, World};
use std::f64::consts::PI;
use std::sync::Arc;

const SHADER: Handle<Shader> = uuid_handle!("3f0c5b86-8f0e-4b0c-9a52-5f0d7f7c1e02");

/// Adds the buffer and what keeps it up to date.
pub(super) fn plugin(app: &mut App) {
    load_internal_asset!(
        app,
        SHADER,
        "../../assets/shaders/grain.wgsl",
        Shader::from_wgsl
    );
    app.init_resource::<GrainBuffer>()
        .init_resource::<ColouredGrains>()
        .add_systems(Update, fill.in_set(ViewSystems::Fill))
        // Where two threads share a core a round would slow the rest of the frame.
        .add_systems(Last, begin_shadows);
}

/// The buffers of all grains, in the order of the world, one for each half of the picture.
#[derive(Resource, Default)]
pub struct GrainBuffer {
    halves: [HalfBuffer; 2],
    shadows_are_whole: bool,
}

/// The buffers of one half.
#[derive(Default)]
struct HalfBuffer {
    /// Others whenever the number of grains is another.
    handles: GrainHandles,
    count: usize,
}

/// What the shaders read of the grains in one half of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct GrainHandles {
    /// A [`DrawnGrain`] of each.
    pub grains: Handle<ShaderBuffer>,
    /// An [`Occlusion`] of each.
    pub shadows: Handle<ShaderBuffer>,
}

/// A grain as the shaders read it.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct DrawnGrain {
    centre: [f32; 3],
    /// For a polyhedron that of the sphere round it.
    radius: f32,
    colour: [f32; 3],
    /// 1 where a liquid covers it, else 0.
    wet: f32,
    /// From body axes to the world's: x, y, z, w; zeros of a sphere without a pattern.
    orientation: [f32; 4],
}

/// The planes beyond all of which everything is cut away, as the shaders read them.
#[derive(Clone, Copy, Debug, Default, PartialEq, ShaderType)]
pub(super) struct CutPlanes {
    /// Normal and distance from the origin of each; every point lies beyond [`EVERYWHERE`], none
    /// beyond zeros.
    planes: [Vec4; 2],
}

const EVERYWHERE: Vec4 = Vec4::new(0.0, 0.0, 0.0, f32::MIN);

impl CutPlanes {
    pub(super) fn of(cut: Option<Cut>) -> Self {
        let planes = match cut {
            None => [Vec4::ZERO; 2],
            Some(Cut::Beyond { axis, position }) => {
                [axis.unit().as_vec3().extend(position as f32), EVERYWHERE]
            }
            Some(Cut::Quarter { x, z }) => [Vec3::X.extend(x as f32), Vec3::Z.extend(z as f32)],
        };
        Self { planes }
    }

    /// Whether the point `x` is cut away.
    pub(super) fn take_away(&self, x: Vec3) -> bool {
        let beyond = |plane: &Vec4| plane.truncate().dot(x) > plane.w;
        self.planes.iter().all(beyond)
    }
}

/// The shape of grain `i`, unless it is a sphere.
pub(super) fn polyhedron(polyhedra: Option<&Polyhedra>, i: usize) -> Option<&Polyhedron> {
    let shape = polyhedra?.shape_of(i);
    (!shape.faces.is_empty()).then_some(shape)
}

/// What decides the grains' colours and shadows beside the world.
type Colouring = (
    ColourBy,
    ColourMap,
    (ColourRange, bool),
    Option<Cut>,
    f32,
    Option<bool>,
);

/// What is kept from one frame to the next, so that a frame needs no new room per grain.
#[derive(Resource, Default)]
struct ColouredGrains {
    colouring: Option<Colouring>,
    halves: [ColouredHalf; 2],
}

impl ColouredGrains {
    fn shadows_are_whole(&self) -> bool {
        self.halves.iter().all(|half| half.shadows.are_whole())
    }
}

/// The same of one half of the picture.
#[derive(Default)]
struct ColouredHalf {
    forms: Forms,
    /// Radius of the sphere of the same volume as each polyhedron [m], for its shadow; none where all
    /// are spheres.
    radii: Vec<f32>,
    /// Which grains have faces; none where all are spheres. Their shapes lie far apart in memory.
    are_faceted: Vec<bool>,
    /// The numbers that the colours show, of each grain.
    values: Vec<f64>,
    shadows: Shadows,
}

/// Rewrites the buffers of grains when the world or the colouring has changed, those of shadows
/// when these are computed.
fn fill(
    shown: Res<ShownWorlds>,
    mut settings: ResMut<ViewSettings>,
    mut kept: ResMut<ColouredGrains>,
    mut buffer: ResMut<GrainBuffer>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    let colouring = (
        settings.colour_by,
        settings.colour_map,
        (settings.range, settings.log_colours),
        settings.cut,
        settings.grain_size,
        settings.show_turning,
    );
    if shown.is_changed() || kept.colouring != Some(colouring) {
        kept.colouring = Some(colouring);
        settings.legend = kept.evaluate(&shown, &settings);
        for half in Half::ALL {
            let drawn = kept.halves[half.index()].redraw(&shown, half, &settings);
            buffer.halves[half.index()].write(drawn, &mut buffers);
        }
    }
    for (half, buffer) in kept.halves.iter_mut().zip(&buffer.halves) {
        if let Some(shadows) = half.shadows.take(buffer.count)
            && let Some(mut buffer) = buffers.get_mut(&buffer.handles.shadows)
        {
            buffer.data = Some(shadows);
        }
    }
    let is_whole = kept.shadows_are_whole();
    if buffer.shadows_are_whole != is_whole {
        buffer.shadows_are_whole = is_whole;
    }
}

/// Begins another round of shadows where they are out of date.
fn begin_shadows(
    shown: Res<ShownWorlds>,
    settings: Res<ViewSettings>,
    mut kept: ResMut<ColouredGrains>,
) {
    let cut = CutPlanes::of(settings.cut);
    for half in Half::ALL {
        let ColouredHalf { radii, shadows, .. } = &mut kept.halves[half.index()];
        let absent = move |centre| cut.take_away(centre);
        let place = |spheres: &mut Vec<(Vec3, f32)>| {
            if let Some(world) = shown.half(half) {
                place(world, radii, settings.grain_size, spheres);
            }
        };
        shadows.begin(place, absent);
    }
}

/// The state whose numbers the colours of this half show: its own, or that with which its run began,
/// where that is known.
fn tells_colour(shown: &ShownWorlds, half: Half, by: ColourBy) -> Option<&World> {
    match by {
        ColourBy::Start(_) => shown.start(half),
        ColourBy::Species | ColourBy::Quantity(_) => shown.half(half),
    }
}

impl GrainBuffer {
    /// Whether the shadows of the state shown are computed: they lag behind it by a few frames.
    pub fn is_whole(&self) -> bool {
        self.shadows_are_whole
    }

    /// The buffers of this half of the picture.
    pub(super) fn handles(&self, half: Half) -> &GrainHandles {
        &self.halves[half.index()].handles
    }
}

impl HalfBuffer {
    /// Hands the bytes of all grains over.
    fn write(&mut self, mut grains: Vec<u8>, buffers: &mut Assets<ShaderBuffer>) {
        if grains.is_empty() {
            // A buffer cannot be empty; nobody draws this one.
            grains.extend_from_slice(bytemuck::bytes_of(&DrawnGrain::zeroed()));
        }
        let count = grains.len() / size_of::<DrawnGrain>();
        if count == self.count
            && let Some(mut buffer) = buffers.get_mut(&self.handles.grains)
        {
            buffer.data = Some(grains);
            return;
        }
        self.count = count;
        // Until they are known.
        let no_shadows = vec![0; count * size_of::<Occlusion>()];
        let mut add =
            |data: &[u8]| buffers.add(ShaderBuffer::new(data, RenderAssetUsages::RENDER_WORLD));
        self.handles = GrainHandles {
            grains: add(&grains),
            shadows: add(&no_shadows),
        };
    }
}

impl ColouredGrains {
    /// Computes the numbers that the colours show; what these mean.
    fn evaluate(&mut self, shown: &ShownWorlds, settings: &ViewSettings) -> Option<Legend> {
        for half in Half::ALL {
            let values = &mut self.halves[half.index()].values;
            values.clear();
            if let (Some(world), Some(quantity)) = (
                tells_colour(shown, half, settings.colour_by),
                settings.colour_by.quantity(),
            ) {
                quantity.append(world, values);
            }
        }
        let values = self.halves.each_ref().map(|half| half.values.as_slice());
        let is_told = |half| tells_colour(shown, half, settings.colour_by).is_some();
        let range = (settings.range, settings.log_colours);
        let before = settings.legend.as_ref();
        let legend = || colour::legend(&values, settings.colour_by, range, before);
        Half::ALL.into_iter().any(is_told).then(legend).flatten()
    }
}

impl ColouredHalf {
    /// Places and colours of the world in this half, a [`DrawnGrain`] each, as bytes; the shadows are
    /// out of date from now on.
    fn redraw(&mut self, shown: &ShownWorlds, half: Half, settings: &ViewSettings) -> Vec<u8> {
        self.shadows.outdate();
        let Some(world) = shown.half(half) else {
            return Vec::new();
        };
        self.look_at_shapes(world);
        let is_told = tells_colour(shown, half, settings.colour_by).is_some();
        let turn_of = self.turn_of(world, shown.turned(half), settings);
        let has_liquid = world.wetting().is_some();
        let is_wet = |i: usize| has_liquid && world.grains.film[i] > 0.0;
        let mut bytes = Vec::with_capacity(world.grains.len() * size_of::<DrawnGrain>());
        let mut places = world.grains.position.iter().enumerate();
        colour::colours(
            &world.grains.species,
            &self.values,
            settings.colour_map,
            settings.legend.as_ref().filter(|_| is_told),
            |colour| {
                let Some((i, x)) = places.next() else { return };
                bytes.extend_from_slice(bytemuck::bytes_of(&DrawnGrain {
                    centre: x.as_vec3().to_array(),
                    radius: settings.grain_size * world.grains.radius[i] as f32,
                    colour,
                    wet: if is_wet(i) { 1.0 } else { 0.0 },
                    orientation: turn_of(i),
                }));
            },
        );
        bytes
    }

    /// Notes what of the shapes of `world` each frame needs, where they are others.
    fn look_at_shapes(&mut self, world: &World) {
        if !self.forms.renew(world) {
            return;
        }
        self.radii.clear();
        self.are_faceted.clear();
        if world.polyhedra.is_some() {
            for i in 0..world.grains.len() {
                let shape = polyhedron(world.polyhedra.as_deref(), i);
                let radius = shape.map_or(world.grains.radius[i], round_radius);
                self.radii.push(radius as f32);
                self.are_faceted.push(shape.is_some());
            }
        }
    }

    /// How far each grain of `world` has turned, as the shaders read it.
    fn turn_of<'a>(
        &'a self,
        world: &'a World,
        turned: Option<&'a [Quat]>,
        settings: &ViewSettings,
    ) -> impl Fn(usize) -> [f32; 4] + use<'a> {
        let polyhedra = world.polyhedra.as_deref();
        let has_pattern = settings.shows_turning(world);
        let is_faceted = |i: usize| self.are_faceted.get(i).copied().unwrap_or(false);
        move |i| {
            let turn = match (polyhedra, turned) {
                // Without its rotation a sphere has no pattern.
                _ if !has_pattern && !is_faceted(i) => None,
                (Some(polyhedra), _) => Some(polyhedra.orientation[i].as_quat()),
                (None, turned) => turned.and_then(|turned| turned.get(i).copied()),
            };
            turn.map_or([0.0; 4], Quat::to_array)
        }
    }
}

/// Appends the spheres (centre, radius) that throw the shadows of `world` to `spheres`.
fn place(world: &World, radii: &[f32], size: f32, spheres: &mut Vec<(Vec3, f32)>) {
    let grains = &world.grains;
    let own = |i: usize| (radii.get(i).copied()).unwrap_or(grains.radius[i] as f32);
    let places = grains.position.iter().enumerate();
    spheres.extend(places.map(|(i, x)| (x.as_vec3(), size * own(i))));
}

/// The shapes of the grains of a world, kept to notice when they change.
#[derive(Default)]
pub(super) struct Forms {
    count: usize,
    shapes: Option<Arc<[Polyhedron]>>,
    shape: Vec<u32>,
}

impl Forms {
    /// Takes over the shapes of `world`; true where they have changed.
    pub(super) fn renew(&mut self, world: &World) -> bool {
        let same_shapes = match (&self.shapes, &world.polyhedra) {
            (None, None) => true,
            (Some(shapes), Some(polyhedra)) => {
                Arc::ptr_eq(shapes, &polyhedra.shapes) && *self.shape == *polyhedra.shape
            }
            _ => false,
        };
        if same_shapes && self.count == world.grains.len() {
            return false;
        }
        let polyhedra = world.polyhedra.as_deref();
        self.count = world.grains.len();
        self.shapes = polyhedra.map(|polyhedra| polyhedra.shapes.clone());
        self.shape = polyhedra.map_or_else(Vec::new, |polyhedra| polyhedra.shape.to_vec());
        true
    }
}

/// Radius of the sphere of the same volume [m].
fn round_radius(shape: &Polyhedron) -> f64 {
    (shape.volume * 3.0 / (4.0 * PI)).cbrt()
}
