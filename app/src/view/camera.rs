//! Where the eye is: a camera that orbits a point, moved by the pointer over the free part of the
//! window.
//!
//! In: drags and scrolls in egui points, requests, the points that should fit. Out: eye, rotation,
//! visible height, and where a point of the world lands in the picture. Nothing here knows of
//! Bevy's camera entity; the rig does.

use crate::view::view_settings::{CameraRequest, ProjectionKind, SAVED_VIEWS, StandardView};
use bevy::math::{EulerRot, Quat, Rect, Vec2, Vec3};
use bevy::prelude::Resource;
use bevy_egui::egui;
use serde::{Deserialize, Serialize};
use std::f32::consts::{FRAC_PI_2, PI};

/// Vertical field of view of the perspective [rad].
const FIELD_OF_VIEW: f32 = 0.5;
/// Yaw and pitch of the view that most scenes open with: a little from the right and from above
/// [rad].
pub(super) const HOME: (f32, f32) = (0.2, 0.17);
/// Share of the picture that [`OrbitCamera::fit`] leaves free in all.
const MARGIN: f32 = 0.09;

/// A camera that orbits [`OrbitCamera::focus`].
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct OrbitCamera {
    /// The point that it looks at and turns round [m].
    pub focus: Vec3,
    /// Angle round the vertical, 0 seen from +z, growing towards +x [rad].
    pub yaw: f32,
    /// Angle above the horizontal [rad].
    pub pitch: f32,
    /// Height of what is visible at the focus [m].
    pub height: f32,
    /// How depth is shown.
    pub projection: ProjectionKind,
    /// Size of the picture in egui points.
    pub viewport: Vec2,
    /// Whether the picture keeps fitting the scene: until a person pans or zooms.
    pub fits: bool,
    /// Yaw and pitch of the view that the scene opens with [rad].
    home: (f32, f32),
    /// How often a view was asked for.
    requests: u32,
    saved: [Option<Pose>; SAVED_VIEWS],
}

/// Where a camera looks from, as a session keeps it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CameraPose {
    focus: [f32; 3],
    yaw: f32,
    pitch: f32,
    height: f32,
    fits: bool,
}

/// Where a camera looks from.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pose {
    focus: Vec3,
    yaw: f32,
    pitch: f32,
    height: f32,
}

impl Default for OrbitCamera {
    fn default() -> Self {
        Self {
            focus: Vec3::ZERO,
            yaw: HOME.0,
            pitch: HOME.1,
            height: 1.0,
            projection: ProjectionKind::Perspective,
            viewport: Vec2::new(1280.0, 720.0),
            fits: true,
            home: HOME,
            requests: 0,
            saved: [None; SAVED_VIEWS],
        }
    }
}

impl OrbitCamera {
    /// Turns round the focus by a drag of the pointer; the scene follows the pointer.
    pub fn orbit(&mut self, drag: Vec2) {
        let turn = PI / self.viewport.min_element().max(1.0);
        self.yaw = (self.yaw - drag.x * turn).rem_euclid(2.0 * PI);
        self.pitch = (self.pitch + drag.y * turn).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// Moves sideways by a drag of the pointer; what lies at the focus stays under the pointer.
    pub fn pan(&mut self, drag: Vec2) {
        let rotation = self.rotation();
        let metres = drag * self.metres_per_point();
        self.focus += rotation * Vec3::new(-metres.x, metres.y, 0.0);
        self.fits = false;
    }

    /// Comes closer by a scroll (positive) at the point `at`, counted from the picture's middle
    /// with y downwards, which stays where it is.
    pub fn zoom(&mut self, scroll: f32, at: Vec2) {
        let before = self.metres_per_point();
        self.height = (self.height * (-scroll / 450.0).exp()).clamp(1e-5, 1e4);
        let moved = at * (before - self.metres_per_point());
        self.focus += self.rotation() * Vec3::new(moved.x, -moved.y, 0.0);
        self.fits = false;
    }

    /// Where it looks from.
    pub fn pose(&self) -> CameraPose {
        CameraPose {
            focus: self.focus.to_array(),
            yaw: self.yaw,
            pitch: self.pitch,
            height: self.height,
            fits: self.fits,
        }
    }

    /// Looks from there; whether there is such a place.
    pub fn take_pose(&mut self, pose: &CameraPose) -> bool {
        let numbers = [pose.yaw, pose.pitch, pose.height];
        let is_place = numbers.iter().chain(&pose.focus).all(|x| x.is_finite());
        if is_place {
            self.focus = Vec3::from_array(pose.focus);
            self.yaw = pose.yaw.rem_euclid(2.0 * PI);
            self.pitch = pose.pitch.clamp(-FRAC_PI_2, FRAC_PI_2);
            self.height = pose.height.clamp(1e-5, 1e4);
            self.fits = pose.fits;
            self.requests = self.requests.wrapping_add(1);
        }
        is_place
    }

    /// Looks from one side, straight along an axis.
    pub fn look_from(&mut self, side: StandardView) {
        (self.yaw, self.pitch) = match side {
            StandardView::Front => (0.0, 0.0),
            StandardView::Back => (PI, 0.0),
            StandardView::Right => (FRAC_PI_2, 0.0),
            StandardView::Left => (-FRAC_PI_2, 0.0),
            StandardView::Above => (0.0, FRAC_PI_2),
            StandardView::Below => (0.0, -FRAC_PI_2),
        };
        self.fits = true;
    }

    /// Does what was asked; the picture then fits the scene again, unless a view was kept or called
    /// back.
    pub fn follow(&mut self, request: CameraRequest) {
        match request {
            CameraRequest::Save(number) => return self.save(number),
            CameraRequest::Recall(number) => return self.recall(number),
            CameraRequest::Home => (self.yaw, self.pitch) = self.home,
            CameraRequest::Fit => {}
            CameraRequest::From(side) => self.look_from(side),
        }
        self.fits = true;
        self.requests = self.requests.wrapping_add(1);
    }

    fn save(&mut self, number: usize) {
        if let Some(place) = self.saved.get_mut(number) {
            *place = Some(Pose {
                focus: self.focus,
                yaw: self.yaw,
                pitch: self.pitch,
                height: self.height,
            });
        }
    }

    fn recall(&mut self, number: usize) {
        if let Some(Some(pose)) = self.saved.get(number).copied() {
            (self.focus, self.height) = (pose.focus, pose.height);
            (self.yaw, self.pitch) = (pose.yaw, pose.pitch);
            self.fits = false;
        }
    }

    /// From now on the scene's view is from `home`, yaw and pitch [rad]; turns there unless a
    /// person has turned away.
    pub(super) fn set_home(&mut self, home: (f32, f32)) {
        if (self.yaw, self.pitch) == self.home {
            (self.yaw, self.pitch) = home;
        }
        self.home = home;
    }

    /// How often [`OrbitCamera::follow`] was called: after each call the scene is measured anew.
    pub(super) fn requests(&self) -> u32 {
        self.requests
    }

    /// Moves so that all `points` [m] are just seen, in the middle, in a picture of the present
    /// shape.
    pub fn fit(&mut self, points: &[Vec3]) {
        if points.is_empty() {
            return;
        }
        let rotation = self.rotation();
        let centre = centre(points);
        let seen = points.iter().map(|p| rotation.inverse() * (*p - centre));
        let tangent = self.tangent();
        let (offset, height) = match self.projection {
            ProjectionKind::Perspective => {
                let (across, up): (Vec<_>, Vec<_>) = seen.map(|p| ((p.x, p.z), (p.y, p.z))).unzip();
                let distance = distance_to_fit(&across, tangent.x)
                    .max(distance_to_fit(&up, tangent.y))
                    * (1.0 + MARGIN);
                let offset = Vec2::new(middle(&across, distance), middle(&up, distance));
                (offset, 2.0 * distance * tangent.y)
            }
            ProjectionKind::Orthographic => {
                let area = seen.fold(Rect::EMPTY, |area, p| area.union_point(p.truncate()));
                let tall = area.height().max(area.width() / self.aspect());
                (area.center(), tall * (1.0 + MARGIN))
            }
        };
        self.focus = centre + rotation * offset.extend(0.0);
        self.height = height.max(1e-5);
    }

    /// Shows the same in a picture of this `size` [points]: all points of `outline` [m] where it fits
    /// these, else at least what is seen now.
    pub(super) fn reshape(&mut self, size: Vec2, outline: &[Vec3]) {
        let before = self.aspect();
        self.viewport = size;
        if self.fits && !outline.is_empty() {
            self.fit(outline);
        } else {
            self.height *= (before / self.aspect()).max(1.0);
        }
    }

    /// From camera axes (x right, y up, z to the viewer) to the world's.
    pub fn rotation(&self) -> Quat {
        Quat::from_euler(EulerRot::YXZ, self.yaw, -self.pitch, 0.0)
    }

    /// Distance of the eye from the focus [m]; for the orthographic picture far enough to have all
    /// in front.
    pub fn distance(&self) -> f32 {
        let perspective = 0.5 * self.height / (0.5 * FIELD_OF_VIEW).tan();
        match self.projection {
            ProjectionKind::Perspective => perspective,
            ProjectionKind::Orthographic => 10.0 * perspective,
        }
    }

    /// Where the eye is [m].
    pub fn eye(&self) -> Vec3 {
        self.focus + self.rotation() * Vec3::Z * self.distance()
    }

    /// Vertical field of view of the perspective [rad].
    pub fn field_of_view(&self) -> f32 {
        FIELD_OF_VIEW
    }

    /// Length at the focus that one egui point covers [m].
    pub fn metres_per_point(&self) -> f32 {
        self.height / self.viewport.y.max(1.0)
    }

    /// Where the point `x` [m] lands in the picture, in points from its upper left corner, and how
    /// many points a metre is there; `None` behind the eye.
    pub fn project(&self, x: Vec3) -> Option<(Vec2, f32)> {
        let seen = self.rotation().inverse() * (x - self.focus);
        let points_per_metre = match self.projection {
            ProjectionKind::Orthographic => 1.0 / self.metres_per_point(),
            ProjectionKind::Perspective => {
                let depth = self.distance() - seen.z;
                if depth <= 0.0 {
                    return None;
                }
                self.distance() / depth / self.metres_per_point()
            }
        };
        let place = self.viewport / 2.0 + Vec2::new(seen.x, -seen.y) * points_per_metre;
        Some((place, points_per_metre))
    }

    /// Whether the point `x` [m] is in the picture.
    pub fn sees(&self, x: Vec3) -> bool {
        let picture = Rect::from_corners(Vec2::ZERO, self.viewport);
        let place = self.project(x);
        place.is_some_and(|(place, _)| picture.contains(place))
    }

    /// The plane through the right edge of the picture: its normal, which points out of the picture,
    /// and its distance from the origin along it [m].
    pub fn right_edge(&self) -> (Vec3, f32) {
        let rotation = self.rotation();
        let (right, forward) = (rotation * Vec3::X, rotation * Vec3::NEG_Z);
        match self.projection {
            ProjectionKind::Perspective => {
                let normal = (right - self.tangent().x * forward).normalize();
                (normal, normal.dot(self.eye()))
            }
            ProjectionKind::Orthographic => {
                let half = 0.5 * self.height * self.aspect();
                (right, right.dot(self.focus) + half)
            }
        }
    }

    fn aspect(&self) -> f32 {
        self.viewport.x.max(1.0) / self.viewport.y.max(1.0)
    }

    /// Tangents of half the angles of view, across and up.
    fn tangent(&self) -> Vec2 {
        let up = (0.5 * FIELD_OF_VIEW).tan();
        Vec2::new(up * self.aspect(), up)
    }
}

/// Lets the pointer over the free part of the window move the camera: drag to orbit, with the right
/// or middle button or Shift to pan, scroll or pinch to zoom, double click to fit.
///
/// The response must come from `root.interact(free_rect, id, Sense::click_and_drag())` after the
/// panels, so that egui decides whether the pointer is on the picture or on a panel.
pub fn apply_response(response: &egui::Response, camera: &mut OrbitCamera) {
    let size = response.rect.size();
    camera.viewport = Vec2::new(size.x, size.y);
    let drag = response.drag_delta();
    let drag = Vec2::new(drag.x, drag.y);
    if response.dragged_by(egui::PointerButton::Primary) {
        if response.ctx.input(|input| input.modifiers.shift) {
            camera.pan(drag);
        } else {
            camera.orbit(drag);
        }
    } else if response.dragged() {
        camera.pan(drag);
    }
    if let Some(pointer) = response.hover_pos() {
        let (scroll, pinch) =
            (response.ctx).input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        let scroll = scroll + 450.0 * pinch.ln();
        if scroll != 0.0 {
            let at = pointer - response.rect.center();
            camera.zoom(scroll, Vec2::new(at.x, at.y));
        }
    }
    if response.double_clicked() {
        camera.follow(CameraRequest::Fit);
    }
}

/// Middle of the box round `points`.
fn centre(points: &[Vec3]) -> Vec3 {
    let low = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    (low + high) / 2.0
}

/// How far off the eye must be to see points (sideways, towards the viewer) within the half angle
/// of this `tangent`, if it stands where that is nearest.
fn distance_to_fit(points: &[(f32, f32)], tangent: f32) -> f32 {
    let farthest = |side: f32| {
        let needed = points.iter().map(|(x, z)| z + side * x / tangent);
        needed.fold(f32::NEG_INFINITY, f32::max)
    };
    f32::midpoint(farthest(1.0), farthest(-1.0))
}

/// Where the eye must stand sideways, at this `distance`, to have points (sideways, towards the
/// viewer) in the middle.
fn middle(points: &[(f32, f32)], distance: f32) -> f32 {
    let mut eye = 0.0;
    // Each round divides the error by the ratio of distance to depth, at least about four.
    for _ in 0..12 {
        let (low, high) = points
            .iter()
            .map(|(x, z)| (x - eye) / (distance - z))
            .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), slope| {
                (low.min(slope), high.max(slope))
            });
        eye += distance * f32::midpoint(low, high);
    }
    eye
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners() -> Vec<Vec3> {
        let mut corners = Vec::new();
        for x in [-0.06, 0.08] {
            for y in [-0.05, 0.06] {
                for z in [-0.011, 0.011] {
                    corners.push(Vec3::new(x, y, z));
                }
            }
        }
        corners
    }

    #[test]
    fn what_lies_beyond_the_right_edge_lies_right_of_the_picture() {
        for projection in [ProjectionKind::Perspective, ProjectionKind::Orthographic] {
            let mut camera = OrbitCamera {
                yaw: 0.7,
                pitch: 0.3,
                projection,
                ..OrbitCamera::default()
            };
            camera.fit(&corners());
            camera.zoom(400.0, Vec2::ZERO);
            let (normal, edge) = camera.right_edge();
            let mut beyond = 0;
            for corner in corners() {
                let (place, _) = camera.project(corner).unwrap();
                let is_beyond = place.x > camera.viewport.x;
                assert_eq!(normal.dot(corner) > edge, is_beyond, "{corner}");
                beyond += u32::from(is_beyond);
            }
            assert!((1..8).contains(&beyond), "{projection:?}: {beyond}");
        }
    }

    /// The box of all points' places, in points.
    fn shown(camera: &OrbitCamera) -> Rect {
        corners().iter().fold(Rect::EMPTY, |area, corner| {
            area.union_point(camera.project(*corner).unwrap().0)
        })
    }

    #[test]
    fn everything_fits_in_the_middle_for_any_direction_shape_and_projection() {
        for projection in [ProjectionKind::Perspective, ProjectionKind::Orthographic] {
            for viewport in [Vec2::new(1200.0, 500.0), Vec2::new(300.0, 900.0)] {
                for (yaw, pitch) in [(0.0, 0.0), (0.3, 0.2), (2.0, -1.0), (0.0, FRAC_PI_2)] {
                    let mut camera = OrbitCamera {
                        yaw,
                        pitch,
                        projection,
                        viewport,
                        ..OrbitCamera::default()
                    };
                    camera.fit(&corners());
                    let area = shown(&camera);
                    // The tight direction fills the picture but for the margin; both are centred,
                    // to a point.
                    let off = (area.center() - viewport / 2.0).abs();
                    assert!(off.max_element() < 1.0, "{area:?}");
                    assert!(area.min.min_element() > 0.0, "{area:?}");
                    let filled = (area.size() / viewport).max_element();
                    assert!((0.88..1.0).contains(&filled), "{filled} {camera:?}");
                }
            }
        }
    }

    #[test]
    fn what_is_in_the_picture_is_seen_and_what_is_beside_it_is_not() {
        let mut camera = OrbitCamera::default();
        camera.fit(&corners());
        assert!(corners().iter().all(|corner| camera.sees(*corner)));
        assert!(!camera.sees(Vec3::new(0.5, 0.0, 0.0)));
        assert!(!camera.sees(camera.eye() + camera.rotation() * Vec3::Z));
    }

    #[test]
    fn views_along_the_axes_see_the_other_two() {
        let mut camera = OrbitCamera::default();
        let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
        for (side, right, up) in [
            (StandardView::Front, x, y),
            (StandardView::Back, -x, y),
            (StandardView::Right, -z, y),
            (StandardView::Left, z, y),
            (StandardView::Above, x, -z),
            (StandardView::Below, x, z),
        ] {
            camera.look_from(side);
            let rotation = camera.rotation();
            // 1e-6: rounding of sines in single precision.
            assert!((rotation * Vec3::X - right).length() < 1e-6, "{side:?}");
            assert!((rotation * Vec3::Y - up).length() < 1e-6, "{side:?}");
        }
    }

    #[test]
    fn a_scene_opens_from_its_own_side_unless_somebody_turned() {
        let mut camera = OrbitCamera::default();
        camera.set_home((0.6, 0.3));
        assert_eq!((camera.yaw, camera.pitch), (0.6, 0.3));
        camera.orbit(Vec2::new(50.0, 0.0));
        let turned = camera.yaw;
        camera.set_home(HOME);
        assert_eq!((camera.yaw, camera.pitch), (turned, 0.3));
        camera.follow(CameraRequest::Home);
        assert_eq!((camera.yaw, camera.pitch), HOME);
    }

    #[test]
    fn a_view_that_was_kept_comes_back_and_stays() {
        let mut camera = OrbitCamera::default();
        camera.follow(CameraRequest::Recall(1));
        assert!(camera.fits, "nothing was kept");
        camera.orbit(Vec2::new(80.0, 30.0));
        camera.zoom(200.0, Vec2::new(50.0, 20.0));
        let kept = camera.clone();
        camera.follow(CameraRequest::Save(1));
        camera.follow(CameraRequest::From(StandardView::Above));
        camera.follow(CameraRequest::Recall(1));
        let pose = |c: &OrbitCamera| (c.focus, c.yaw, c.pitch, c.height, c.fits);
        assert_eq!(pose(&camera), pose(&kept));
        camera.follow(CameraRequest::Save(99));
        camera.follow(CameraRequest::Recall(99));
    }

    #[test]
    fn panned_focus_follows_the_pointer() {
        let mut camera = OrbitCamera::default();
        let point = camera.focus;
        let before = camera.project(point).unwrap().0;
        camera.pan(Vec2::new(30.0, -12.0));
        let moved = camera.project(point).unwrap().0 - before;
        // A thousandth of a point: single precision.
        assert!((moved - Vec2::new(30.0, -12.0)).length() < 1e-3, "{moved}");
    }

    #[test]
    fn zoom_keeps_the_point_under_the_pointer() {
        let mut camera = OrbitCamera::default();
        let at = Vec2::new(200.0, -100.0);
        let right_and_down = Vec3::new(at.x, -at.y, 0.0) * camera.metres_per_point();
        let point = camera.focus + camera.rotation() * right_and_down;
        camera.zoom(120.0, at);
        let place = camera.project(point).unwrap().0 - camera.viewport / 2.0;
        // A hundredth of a point: single precision.
        assert!((place - at).length() < 1e-2, "{place}");
        assert!(camera.height < 1.0);
    }

    #[test]
    fn orbit_never_turns_upside_down() {
        let mut camera = OrbitCamera::default();
        camera.orbit(Vec2::new(0.0, 1e4));
        assert!((camera.rotation() * Vec3::Y).y > -1e-6);
        camera.orbit(Vec2::new(0.0, -1e5));
        assert!((camera.rotation() * Vec3::Y).y > -1e-6);
    }
}
