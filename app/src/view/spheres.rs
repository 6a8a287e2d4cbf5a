//! Spheres: one draw for all of them, exact.
//!
//! In: the buffer of grains and which of them are spheres. Out: one entity whose mesh is a quad per
//! sphere; the shader finds the grain in the buffer and raymarches it.

use crate::simulation::DrawnIn;
use crate::view::grain_buffer::{CutPlanes, Forms, GrainBuffer, polyhedron};
use crate::view::quads::{self, quads};
use crate::view::shown_worlds::{ShownWorlds, ViewSystems, layers};
use crate::view::view_settings::ViewSettings;
use bevy::asset::{load_internal_asset, uuid_handle};
use bevy::camera::visibility::NoFrustumCulling;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError,
};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::ShaderRef;
use grainfall::lab::Half;

const SHADER: Handle<Shader> = uuid_handle!("6d0f7a0e-64c1-4a53-9c2e-2f6f0a4b5c11");

/// Adds the spheres' material, their entity and what keeps it up to date.
pub(super) fn plugin(app: &mut App) {
    load_internal_asset!(
        app,
        SHADER,
        "../../assets/shaders/spheres.wgsl",
        Shader::from_wgsl
    );
    app.add_plugins(MaterialPlugin::<SphereMaterial>::default())
        .add_systems(Startup, spawn)
        .add_systems(Update, update.in_set(ViewSystems::Draw));
}

#[derive(Asset, TypePath, AsBindGroup, Clone)]
struct SphereMaterial {
    #[storage(0, read_only)]
    grains: Handle<ShaderBuffer>,
    #[uniform(1)]
    cut: CutPlanes,
    #[storage(2, read_only)]
    shadows: Handle<ShaderBuffer>,
}

impl Material for SphereMaterial {
    fn vertex_shader() -> ShaderRef {
        SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        AlphaMode::AlphaToCoverage
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

/// The entity that draws all spheres of one half of the picture.
#[derive(Component)]
struct SphereImpostors {
    /// What its mesh was made of.
    forms: Forms,
    /// Whether there are any.
    any: bool,
}

fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<SphereMaterial>>,
    grains: Res<GrainBuffer>,
) {
    for half in Half::ALL {
        commands.spawn((
            DrawnIn(half),
            layers(half),
            SphereImpostors {
                forms: Forms::default(),
                any: false,
            },
            Mesh3d(meshes.add(quads(&[0]))),
            MeshMaterial3d(materials.add(SphereMaterial {
                grains: grains.handles(half).grains.clone(),
                shadows: grains.handles(half).shadows.clone(),
                cut: CutPlanes::default(),
            })),
            Visibility::Hidden,
            NoFrustumCulling,
        ));
    }
}

/// Draws the spheres of the worlds shown, from the present buffers and cut as asked.
fn update(
    shown: Res<ShownWorlds>,
    settings: Res<ViewSettings>,
    grains: Res<GrainBuffer>,
    mut halves: Query<(
        &DrawnIn,
        &mut SphereImpostors,
        &mut Mesh3d,
        &MeshMaterial3d<SphereMaterial>,
        &mut Visibility,
    )>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<SphereMaterial>>,
) {
    let cut = CutPlanes::of(settings.cut);
    for (&DrawnIn(half), mut drawn, mut mesh, material, mut visibility) in &mut halves {
        let world = shown.half(half);
        if let Some(world) = world
            && shown.is_changed()
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
        let own = grains.handles(half);
        if materials
            .get(&material.0)
            .is_some_and(|material| material.cut != cut || material.grains != own.grains)
            && let Some(mut material) = materials.get_mut(&material.0)
        {
            material.cut = cut;
            material.grains = own.grains.clone();
            material.shadows = own.shadows.clone();
        }
    }
}
