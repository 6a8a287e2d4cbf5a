//! Ghosts: where grains are drawn smaller than they are, what they are at full size, as thin as
//! glass round the forces between them.
//!
//! In: the buffer of grains, the meshes of polyhedra. Out: one more draw of the spheres, and of each
//! mesh. Ghosts only add light to what lies behind them, or on a light background only take it away,
//! so that they look the same in whatever order they are drawn.

use crate::simulation::DrawnIn;
use crate::view::grain_buffer::{CutPlanes, Forms, GrainBuffer, polyhedron};
use crate::view::polyhedron_meshes::{Chunk, facet_layout};
use crate::view::quads::{self, quads};
use crate::view::shown_worlds::{ShownWorlds, ViewSystems, layers};
use crate::view::view_settings::{Background, ViewSettings};
use bevy::asset::{load_internal_asset, uuid_handle};
use bevy::camera::visibility::NoFrustumCulling;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::ShaderRef;
use grainfall::lab::Half;

const SHADER: Handle<Shader> = uuid_handle!("2f9c1d54-70a8-4a0e-9d1b-6c3a5b7e8f42");

/// How strong the rim of a lone ghost is. Of many grains some three hundredths of the cube root of
/// their number lie one behind the other for each that is seen: their sum stays as strong.
const STRENGTH: f32 = 1.1;

/// Adds the ghosts' material, their entities and what keeps them up to date.
pub(super) fn plugin(app: &mut App) {
    load_internal_asset!(
        app,
        SHADER,
        "../../assets/shaders/ghosts.wgsl",
        Shader::from_wgsl
    );
    app.add_plugins(MaterialPlugin::<GhostMaterial>::default())
        .init_resource::<GhostMaterials>()
        .add_systems(Startup, spawn)
        .add_systems(
            Update,
            (look, draw_spheres, draw_polyhedra)
                .chain()
                .after(ViewSystems::Draw),
        );
}

#[derive(Asset, TypePath, AsBindGroup, Clone)]
#[bind_group_data(HasFacets)]
struct GhostMaterial {
    #[storage(0, read_only)]
    grains: Handle<ShaderBuffer>,
    #[uniform(1)]
    cut: CutPlanes,
    #[uniform(2)]
    look: GhostLook,
    has_facets: bool,
}

/// How ghosts look, as the shader reads it.
#[derive(Clone, Copy, Debug, Default, PartialEq, ShaderType)]
struct GhostLook {
    /// Full size over the size in the buffer of grains.
    size: f32,
    /// How strong a rim is.
    strength: f32,
    /// 1 where ghosts take light away, else 0.
    darkens: f32,
}

/// Whether the mesh is one of facets: part of the pipeline's key, as its corners are others.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
#[repr(C)]
struct HasFacets(bool);

impl From<&GhostMaterial> for HasFacets {
    fn from(material: &GhostMaterial) -> Self {
        Self(material.has_facets)
    }
}

impl Material for GhostMaterial {
    fn vertex_shader() -> ShaderRef {
        SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        if self.look.darkens > 0.0 {
            AlphaMode::Multiply
        } else {
            AlphaMode::Add
        }
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
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        if !key.bind_group_data.0 {
            return quads::specialize(descriptor, layout);
        }
        descriptor.vertex.buffers = vec![facet_layout(layout)?];
        descriptor.vertex.shader_defs.push("FACETS".into());
        if let Some(fragment) = &mut descriptor.fragment {
            fragment.shader_defs.push("FACETS".into());
        }
        Ok(())
    }
}

/// The materials of each half of the picture: of spheres, and of polyhedra.
#[derive(Resource, Default)]
struct GhostMaterials {
    spheres: [Handle<GhostMaterial>; 2],
    polyhedra: [Handle<GhostMaterial>; 2],
}

/// The entity that draws the ghosts of all spheres of one half of the picture.
#[derive(Component, Default)]
struct GhostImpostors {
    /// What its mesh was made of.
    forms: Forms,
    /// Whether there are any.
    any: bool,
}

/// The ghosts of the grains in one mesh of polyhedra.
#[derive(Component)]
struct GhostChunk;

fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<GhostMaterial>>,
    mut own: ResMut<GhostMaterials>,
    grains: Res<GrainBuffer>,
) {
    let mut material = |half: Half, has_facets: bool| {
        materials.add(GhostMaterial {
            grains: grains.handles(half).grains.clone(),
            cut: CutPlanes::default(),
            look: GhostLook::default(),
            has_facets,
        })
    };
    own.spheres = Half::ALL.map(|half| material(half, false));
    own.polyhedra = Half::ALL.map(|half| material(half, true));
    for half in Half::ALL {
        commands.spawn((
            DrawnIn(half),
            layers(half),
            GhostImpostors::default(),
            Mesh3d(meshes.add(quads(&[0]))),
            MeshMaterial3d(own.spheres[half.index()].clone()),
            Visibility::Hidden,
            NoFrustumCulling,
        ));
    }
}

/// Lets ghosts be as large, as strong and as much cut away as asked.
fn look(
    shown: Res<ShownWorlds>,
    settings: Res<ViewSettings>,
    grains: Res<GrainBuffer>,
    own: Res<GhostMaterials>,
    mut materials: ResMut<Assets<GhostMaterial>>,
) {
    if !settings.shows_ghosts() {
        return;
    }
    let cut = CutPlanes::of(settings.cut);
    for half in Half::ALL {
        let count = shown.half(half).map_or(1, |world| world.grains.len());
        let look = GhostLook {
            size: 1.0 / settings.grain_size,
            strength: STRENGTH / (count.max(1) as f32).cbrt(),
            darkens: f32::from(u8::from(settings.background == Background::Light)),
        };
        let buffer = &grains.handles(half).grains;
        for handle in [&own.spheres[half.index()], &own.polyhedra[half.index()]] {
            let stale = |material: &GhostMaterial| {
                material.cut != cut || material.look != look || material.grains != *buffer
            };
            if materials.get(handle).is_some_and(stale)
                && let Some(mut material) = materials.get_mut(handle)
            {
                (material.cut, material.look) = (cut, look);
                material.grains = buffer.clone();
            }
        }
    }
}

/// Draws the ghosts of the spheres where they are asked for.
fn draw_spheres(
    shown: Res<ShownWorlds>,
    settings: Res<ViewSettings>,
    mut halves: Query<(&DrawnIn, &mut GhostImpostors, &mut Mesh3d, &mut Visibility)>,
    mut meshes: ResMut<Assets<Mesh>>,
) {
    let are_shown = settings.shows_ghosts();
    for (&DrawnIn(half), mut drawn, mut mesh, mut visibility) in &mut halves {
        let world = shown.half(half).filter(|_| are_shown);
        if let Some(world) = world
            && drawn.forms.renew(world)
        {
            let polyhedra = world.polyhedra.as_deref();
            let is_sphere = |i: &u32| polyhedron(polyhedra, *i as usize).is_none();
            let spheres: Vec<u32> = (0..world.grains.len() as u32).filter(is_sphere).collect();
            drawn.any = !spheres.is_empty();
            // A mesh cannot be empty.
            if drawn.any {
                mesh.0 = meshes.add(quads(&spheres));
            }
        }
        visibility.set_if_neq(if drawn.any && world.is_some() {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        });
    }
}

/// Gives each mesh of polyhedra its ghosts, and takes them away again.
fn draw_polyhedra(
    mut commands: Commands,
    settings: Res<ViewSettings>,
    own: Res<GhostMaterials>,
    chunks: Query<(Entity, &DrawnIn, &Mesh3d, Option<&Children>), With<Chunk>>,
    ghosts: Query<Entity, With<GhostChunk>>,
) {
    if !settings.shows_ghosts() {
        for ghost in &ghosts {
            commands.entity(ghost).despawn();
        }
        return;
    }
    for (chunk, &DrawnIn(half), mesh, children) in &chunks {
        if children.is_some_and(|children| !children.is_empty()) {
            continue;
        }
        let material = own.polyhedra[half.index()].clone();
        let ghost = (
            GhostChunk,
            layers(half),
            mesh.clone(),
            MeshMaterial3d(material),
            NoFrustumCulling,
        );
        commands.entity(chunk).with_child(ghost);
    }
}
