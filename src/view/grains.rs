//! What all grains have in common in the picture, whatever their shape: place, colour, shadow, and what is cut away.
//!
//! In: the world shown and how to colour it. Out: one buffer with an entry per grain, rewritten when the world or the
//! colours change, and the legend. Who draws a shape finds its grains in that buffer by their index, so that nothing is
//! done per grain on the processor but filling it.

use super::occlusion::occlusions;
use super::{ColourBy, ColourMap, ColourRange, Cut, Shown, ViewSettings, colour};
use crate::world::{Polyhedra, Polyhedron, World};
use bevy::asset::{RenderAssetUsages, load_internal_asset, uuid_handle};
use bevy::prelude::*;
use bevy::render::render_resource::ShaderType;
use bevy::render::storage::ShaderBuffer;
use bytemuck::{Pod, Zeroable};
use std::f64::consts::PI;

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
        .add_systems(Update, fill.in_set(super::ViewSystems::Fill));
}

/// The buffer of all grains, in the order of the world.
#[derive(Resource, Default)]
pub(super) struct GrainBuffer {
    /// The buffer; another one whenever the number of grains is another.
    pub handle: Handle<ShaderBuffer>,
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
    /// [`super::occlusion::Occlusion`], in its order.
    hidden_mean: f32,
    hidden_gradient: [f32; 3],
    hidden_quadrupole: [f32; 5],
    /// From body axes to the world's: x, y, z, w.
    orientation: [f32; 4],
}

/// The planes beyond all of which everything is cut away, as the shaders read them.
#[derive(Clone, Copy, Debug, Default, PartialEq, ShaderType)]
pub(super) struct CutPlanes {
    /// Normal and distance from the origin of each; every point lies beyond [`EVERYWHERE`], none beyond zeros.
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
    fn take_away(&self, x: Vec3) -> bool {
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
type Colouring = (ColourBy, ColourMap, ColourRange, Option<Cut>);

/// Rewrites the buffer when the world or the colouring is another.
fn fill(
    shown: Res<Shown>,
    mut settings: ResMut<ViewSettings>,
    mut last: Local<Option<Colouring>>,
    mut drawn: ResMut<GrainBuffer>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    let colouring = (
        settings.colour_by,
        settings.colour_map,
        settings.range,
        settings.cut,
    );
    if !shown.is_changed() && *last == Some(colouring) {
        return;
    }
    *last = Some(colouring);
    let world = shown.world();
    settings.legend = world.and_then(|world| {
        let before = settings.legend.as_ref();
        colour::legend(world, settings.colour_by, settings.range, before)
    });
    let mut grains = world.map_or_else(Vec::new, |world| drawn_grains(world, &settings));
    if grains.is_empty() {
        // A buffer cannot be empty; nobody draws this one.
        grains.push(DrawnGrain::zeroed());
    }
    let bytes = bytemuck::cast_slice(&grains);
    if grains.len() == drawn.count
        && let Some(mut buffer) = buffers.get_mut(&drawn.handle)
    {
        buffer.data = Some(bytes.to_vec());
    } else {
        drawn.count = grains.len();
        drawn.handle = buffers.add(ShaderBuffer::new(bytes, RenderAssetUsages::RENDER_WORLD));
    }
}

fn drawn_grains(world: &World, settings: &ViewSettings) -> Vec<DrawnGrain> {
    let grains = &world.grains;
    let polyhedra = world.polyhedra.as_deref();
    let spheres: Vec<(Vec3, f32)> = (0..grains.len())
        .map(|i| {
            let radius = polyhedron(polyhedra, i).map_or(grains.radius[i], round_radius);
            (grains.position[i].as_vec3(), radius as f32)
        })
        .collect();
    let cut = CutPlanes::of(settings.cut);
    let hidden = occlusions(&spheres, |x| cut.take_away(x));
    let mut drawn = Vec::with_capacity(grains.len());
    colour::colours(
        world,
        settings.colour_by,
        settings.colour_map,
        settings.legend.as_ref(),
        |colour| {
            let i = drawn.len();
            let hidden = hidden[i];
            drawn.push(DrawnGrain {
                centre: spheres[i].0.to_array(),
                radius: grains.radius[i] as f32,
                colour,
                hidden_mean: hidden.mean,
                hidden_gradient: hidden.gradient.to_array(),
                hidden_quadrupole: hidden.quadrupole,
                orientation: polyhedra.map_or([0.0, 0.0, 0.0, 1.0], |polyhedra| {
                    polyhedra.orientation[i].as_quat().to_array()
                }),
            });
        },
    );
    drawn
}

/// Radius of the sphere of the same volume [m].
fn round_radius(shape: &Polyhedron) -> f64 {
    (shape.volume * 3.0 / (4.0 * PI)).cbrt()
}
