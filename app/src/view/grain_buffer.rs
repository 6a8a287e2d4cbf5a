//! What all grains have in common in the picture, whatever their shape: place, colour, shadow, and
//! what is cut away.
//!
//! In: the world shown and how to colour it. Out: one buffer with an entry per grain, rewritten
//! when the world or the colours change, and the legend. Who draws a shape finds its grains in that
//! buffer by their index, so that nothing is done per grain on the processor but filling it.

use crate::view::colour;
use crate::view::occlusion::Shadows;
use crate::view::shown_worlds::{ShownWorlds, ViewSystems};
use crate::view::view_settings::{ColourBy, ColourMap, ColourRange, Cut, ViewSettings};
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

/// The buffer of one half.
#[derive(Default)]
struct HalfBuffer {
    /// The buffer; another one whenever the number of grains is another.
    handle: Handle<ShaderBuffer>,
    count: usize,
}

/// A grain as the shaders read it.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct DrawnGrain {
    centre: [f32; 3],
    /// For a polyhedron that of the sphere round it.
    radius: f32,
    colour: [f32; 3],
    /// [`Occlusion`](crate::view::occlusion::Occlusion), in its order.
    hidden_mean: f32,
    hidden_gradient: [f32; 3],
    hidden_quadrupole: [f32; 5],
    /// From body axes to the world's: x, y, z, w; zeros of a sphere without a pattern.
    orientation: [f32; 4],
    /// 1 where a liquid covers it, else 0.
    wet: f32,
    unused: [f32; 3],
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
    /// Radius of the sphere of the same volume as each polyhedron [m]; none where all are spheres.
    radii: Vec<f32>,
    spheres: Vec<(Vec3, f32)>,
    shadows: Shadows,
    drawn: Vec<DrawnGrain>,
}

/// Rewrites the buffer when the world or the colouring has changed, and while shadows are still
/// being computed.
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
    let moved = shown.is_changed();
    let recoloured = kept.colouring != Some(colouring);
    if !moved && !recoloured && kept.shadows_are_whole() {
        return;
    }
    if moved || recoloured {
        kept.colouring = Some(colouring);
        let told = |half| tells_colour(&shown, half, settings.colour_by);
        let worlds: Vec<&World> = Half::ALL.into_iter().filter_map(told).collect();
        let before = settings.legend.as_ref();
        let range = (settings.range, settings.log_colours);
        settings.legend = colour::legend(&worlds, settings.colour_by, range, before);
        for half in Half::ALL {
            let turned = shown.turned(half);
            let told = tells_colour(&shown, half, settings.colour_by);
            let worlds = shown.half(half).map(|world| (world, told));
            kept.halves[half.index()].redraw(worlds, turned, &settings);
        }
    }
    for (half, buffer) in kept.halves.iter_mut().zip(&mut buffer.halves) {
        let has_shadows = half.shadows.take(half.spheres.len());
        if has_shadows || moved || recoloured {
            half.shade();
            buffer.write(&half.drawn, &mut buffers);
        }
    }
    buffer.shadows_are_whole = kept.shadows_are_whole();
}

/// Begins another round of shadows where they are out of date.
fn begin_shadows(settings: Res<ViewSettings>, mut kept: ResMut<ColouredGrains>) {
    let cut = CutPlanes::of(settings.cut);
    for half in &mut kept.halves {
        let absent = move |centre| cut.take_away(centre);
        half.shadows.begin(&half.spheres, absent);
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

    /// The buffer of this half of the picture.
    pub(super) fn handle(&self, half: Half) -> &Handle<ShaderBuffer> {
        &self.halves[half.index()].handle
    }
}

impl HalfBuffer {
    fn write(&mut self, grains: &[DrawnGrain], buffers: &mut Assets<ShaderBuffer>) {
        // A buffer cannot be empty; nobody draws this one.
        let nobody = [DrawnGrain::zeroed()];
        if grains.is_empty() && self.count == nobody.len() {
            return;
        }
        let grains = if grains.is_empty() { &nobody } else { grains };
        let bytes = bytemuck::cast_slice(grains);
        if grains.len() == self.count
            && let Some(mut buffer) = buffers.get_mut(&self.handle)
        {
            buffer.data = Some(bytes.to_vec());
        } else {
            self.count = grains.len();
            self.handle = buffers.add(ShaderBuffer::new(bytes, RenderAssetUsages::RENDER_WORLD));
        }
    }
}

impl ColouredHalf {
    /// Writes places and colours of a world, with the one whose numbers those tell, and lets the
    /// shadows follow.
    fn redraw(
        &mut self,
        worlds: Option<(&World, Option<&World>)>,
        turned: Option<&[Quat]>,
        settings: &ViewSettings,
    ) {
        self.drawn.clear();
        self.spheres.clear();
        if let Some((world, told)) = worlds {
            self.place(world, settings.grain_size);
            self.colour(world, told, turned, settings);
        }
        self.shadows.outdate();
    }

    fn place(&mut self, world: &World, size: f32) {
        let grains = &world.grains;
        if self.forms.renew(world) {
            self.radii.clear();
            if world.polyhedra.is_some() {
                let round = |i| polyhedron(world.polyhedra.as_deref(), i).map(round_radius);
                let radius = |i: usize| round(i).unwrap_or(grains.radius[i]) as f32;
                self.radii.extend((0..grains.len()).map(radius));
            }
        }
        let own = |i: usize| (self.radii.get(i).copied()).unwrap_or(grains.radius[i] as f32);
        let places = grains.position.iter().enumerate();
        (self.spheres).extend(places.map(|(i, x)| (x.as_vec3(), size * own(i))));
    }

    fn colour(
        &mut self,
        world: &World,
        told: Option<&World>,
        turned: Option<&[Quat]>,
        settings: &ViewSettings,
    ) {
        let polyhedra = world.polyhedra.as_deref();
        let has_pattern = settings.shows_turning(world);
        let turn_of = |i: usize| match (polyhedra, turned) {
            // Without its rotation a sphere has no pattern.
            _ if !has_pattern && polyhedron(polyhedra, i).is_none() => None,
            (Some(polyhedra), _) => Some(polyhedra.orientation[i].as_quat()),
            (None, turned) => turned.and_then(|turned| turned.get(i).copied()),
        };
        let has_liquid = world.wetting().is_some();
        let is_wet = |i: usize| has_liquid && world.grains.film[i] > 0.0;
        let (drawn, spheres) = (&mut self.drawn, &self.spheres);
        colour::colours(
            told.unwrap_or(world),
            settings.colour_by,
            settings.colour_map,
            settings.legend.as_ref().filter(|_| told.is_some()),
            |colour| {
                let i = drawn.len();
                drawn.push(DrawnGrain {
                    centre: spheres[i].0.to_array(),
                    radius: settings.grain_size * world.grains.radius[i] as f32,
                    colour,
                    orientation: turn_of(i).map_or([0.0; 4], Quat::to_array),
                    wet: if is_wet(i) { 1.0 } else { 0.0 },
                    ..DrawnGrain::zeroed()
                });
            },
        );
    }

    /// Writes the shadows, as far as they are known.
    fn shade(&mut self) {
        for (grain, hidden) in self.drawn.iter_mut().zip(self.shadows.hidden()) {
            grain.hidden_mean = hidden.mean;
            grain.hidden_gradient = hidden.gradient.to_array();
            grain.hidden_quadrupole = hidden.quadrupole;
        }
    }
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
