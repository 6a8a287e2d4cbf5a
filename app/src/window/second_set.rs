//! The image and the cameras of the second picture, off screen.
//!
//! In: how a picture is to look. Out: an image of its size with everything drawn into it, while the
//! window goes on as it is. They are made for the first picture that needs them.

use crate::ui::SecondPicturePass;
use crate::view::{OfSecondPicture, SecondLook, SecondOverlay, SecondPicture, second_camera};
use crate::window::canvas::target_image;
use crate::window::pipelines::Pipelines;
use bevy::camera::visibility::RenderLayers;
use bevy::camera::{CameraOutputMode, ClearColorConfig, RenderTarget};
use bevy::ecs::system::SystemParam;
use bevy::math::UVec2;
use bevy::prelude::*;
use bevy::render::render_resource::BlendState;
use bevy::render::view::screenshot::Screenshot;
use bevy_egui::{EguiGlobalSettings, EguiSchedule};
use grainfall::lab::Half;

/// What the cameras draw into while nothing is wanted [pixels].
const NOTHING: RenderTarget = RenderTarget::None {
    size: UVec2::splat(16),
};

/// The image that they draw into.
#[derive(Resource, Default)]
struct Target {
    image: Option<(UVec2, Handle<Image>)>,
    has_cameras: bool,
}

/// Prepares `app` for second pictures.
pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Target>();
    Pipelines::count_in(app);
}

/// The second picture as whoever takes it works it.
#[derive(SystemParam)]
pub(super) struct SecondSet<'w, 's> {
    picture: ResMut<'w, SecondPicture>,
    target: ResMut<'w, Target>,
    images: ResMut<'w, Assets<Image>>,
    cameras: Query<'w, 's, &'static mut RenderTarget, OfSecondPicture>,
    pipelines: Res<'w, Pipelines>,
    panels: Option<Res<'w, EguiGlobalSettings>>,
    commands: Commands<'w, 's>,
}

impl SecondSet<'_, '_> {
    /// Draws it as `look` says, from now on.
    pub(super) fn show(&mut self, look: SecondLook) {
        if !matches!(&self.target.image, Some((size, _)) if *size == look.size) {
            let image = self.images.add(target_image(look.size));
            for mut target in &mut self.cameras {
                *target = RenderTarget::Image(image.clone().into());
            }
            self.target.image = Some((look.size, image.clone()));
            if !std::mem::replace(&mut self.target.has_cameras, true) {
                self.spawn_cameras(&RenderTarget::Image(image.into()));
            }
        }
        self.picture.draw(Some(look));
    }

    fn spawn_cameras(&mut self, target: &RenderTarget) {
        for half in Half::ALL {
            let camera = second_camera(half);
            self.commands.spawn((camera, target.clone()));
        }
        if self.panels.is_some() {
            self.commands.spawn((
                SecondOverlay,
                EguiSchedule::new(SecondPicturePass),
                over_everything(),
                target.clone(),
            ));
        }
    }

    /// Draws it no longer for now.
    pub(super) fn rest(&mut self) {
        self.picture.draw(None);
    }

    /// Draws it no longer and gives its memory back.
    pub(super) fn put_away(&mut self) {
        self.rest();
        if self.target.image.take().is_some() {
            for mut target in &mut self.cameras {
                *target = NOTHING;
            }
        }
    }

    /// Width and height of `image` [pixels].
    pub(super) fn size_of(&self, image: &Handle<Image>) -> Option<UVec2> {
        self.images.get(image).map(Image::size)
    }

    /// Asks for what is drawn; none where nothing is.
    pub(super) fn screenshot(&self) -> Option<Screenshot> {
        let (_, image) = self.target.image.as_ref()?;
        self.picture
            .look()
            .map(|_| Screenshot::image(image.clone()))
    }

    /// Whether the renderer has all that it draws with.
    pub(super) fn is_ready(&self) -> bool {
        self.pipelines.are_made()
    }
}

/// A camera that draws panels and marks over what others drew.
pub(super) fn over_everything() -> impl Bundle {
    (
        Camera2d,
        RenderLayers::none(),
        Msaa::Off,
        Camera {
            // After those of both halves of the picture.
            order: 2,
            output_mode: CameraOutputMode::Write {
                blend_state: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                clear_color: ClearColorConfig::None,
            },
            clear_color: ClearColorConfig::Custom(Color::NONE),
            ..default()
        },
    )
}
