//! Walls in the solver: where they are during a call, how they move, how far they have come.
//!
//! In: a world's container. Out: the walls at each step, and the container's surfaces and angle
//! after the last one.
//!
//! Planes and tubes move by their velocity, a step at a time, so that where they are does not
//! depend on how many steps a call takes. What turns about its own axis keeps its surface: a drum's
//! rim and plates stay where they are, and their spin is felt as the velocity at a contact. A mesh
//! turns or moves as a whole. Every
//! worker of a batch has its own copy and moves it as all others do; so nobody waits for a wall.
//!
//! Not here: the distance of a point from a wall ([`Surface::distance`]).

use crate::world::{Container, Surface, WallMotion};

/// What a step reads of a wall.
#[derive(Clone, Debug, PartialEq)]
pub struct WallBody {
    /// Where it is.
    pub surface: Surface,
    /// How it moves.
    pub motion: WallMotion,
}

/// The walls of a container, in its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walls(Vec<WallBody>);

impl std::ops::Deref for Walls {
    type Target = [WallBody];

    fn deref(&self) -> &[WallBody] {
        &self.0
    }
}

impl Walls {
    /// Takes the walls of `container` in.
    pub fn load(&mut self, container: &Container) {
        self.0.clear();
        self.0.extend(container.walls.iter().map(|wall| WallBody {
            surface: wall.surface.clone(),
            motion: wall.motion,
        }));
    }

    /// Puts them back after `steps` steps of `dt` [s]; the angle of what turns follows. It is added up
    /// step by step, so that it does not depend on how many steps a call takes.
    pub fn store(&self, container: &mut Container, steps: u64, dt: f64) {
        let turn = container.turning_speed() * dt;
        (0..steps).for_each(|_| container.angle += turn);
        for (wall, body) in container.walls.iter_mut().zip(&self.0) {
            wall.surface = body.surface.clone();
        }
    }

    /// Moves those that have a velocity by one step of `dt` [s].
    pub fn advance(&mut self, dt: f64) {
        for wall in &mut self.0 {
            match &mut wall.surface {
                Surface::Plane { point, .. } => *point += wall.motion.velocity * dt,
                Surface::Tube { rim, .. } => *rim += wall.motion.velocity.y * dt,
                Surface::Cylinder { .. } => {}
                Surface::Mesh(mesh) => mesh.advance(&wall.motion, dt),
            }
        }
    }

    /// Their surfaces.
    pub fn surfaces(&self) -> impl Iterator<Item = &Surface> + '_ {
        self.0.iter().map(|wall| &wall.surface)
    }

    /// Whether they are where they were in `old`, meshes but for `slack` [m].
    pub fn are_near(&self, old: &[Surface], slack: f64) -> bool {
        let is_near = |(wall, old): (&WallBody, &Surface)| match &wall.surface {
            Surface::Mesh(_) => wall.moved_from(old) < slack,
            surface => surface == old,
        };
        old.len() == self.0.len() && self.0.iter().zip(old).all(is_near)
    }

    /// How far any of them is from where it was in `old`; without bound where it is another surface
    /// [m].
    pub fn moved_from(&self, old: &[Surface]) -> f64 {
        if old.len() != self.0.len() {
            return f64::INFINITY;
        }
        let moved = self
            .0
            .iter()
            .zip(old)
            .map(|(wall, old)| wall.moved_from(old));
        moved.fold(0.0, f64::max)
    }

    /// Speed of the fastest of them along its normal [m/s].
    pub fn speed(&self) -> f64 {
        self.0.iter().map(WallBody::speed).fold(0.0, f64::max)
    }

    /// Steps of `dt` [s] in which no wall moves by more than `slack` [m], at least one.
    pub fn steps_within(&self, slack: f64, dt: f64) -> u64 {
        let speed = self.speed();
        if speed > 0.0 {
            (slack / (speed * dt)).max(1.0) as u64
        } else {
            u64::MAX
        }
    }
}

impl WallBody {
    /// Speed at which the surface moves along its normal, of a mesh a bound of it [m/s].
    fn speed(&self) -> f64 {
        match &self.surface {
            Surface::Plane { normal, .. } => self.motion.velocity.dot(*normal).abs(),
            Surface::Tube { .. } => self.motion.velocity.y.abs(),
            Surface::Cylinder { .. } => 0.0,
            Surface::Mesh(mesh) => mesh.speed(&self.motion),
        }
    }

    /// How far the surface is from where it was [m]; without bound where it is another surface.
    fn moved_from(&self, old: &Surface) -> f64 {
        match (&self.surface, old) {
            (Surface::Mesh(mesh), Surface::Mesh(old)) => mesh.moved_from(old),
            (
                &Surface::Plane { point, normal },
                &Surface::Plane {
                    point: p,
                    normal: n,
                },
            ) if normal == n => (point - p).dot(normal).abs(),
            (&Surface::Tube { radius, rim }, &Surface::Tube { radius: r, rim: y })
                if radius == r =>
            {
                (rim - y).abs()
            }
            (&Surface::Cylinder { radius }, &Surface::Cylinder { radius: r }) if radius == r => 0.0,
            _ => f64::INFINITY,
        }
    }
}
