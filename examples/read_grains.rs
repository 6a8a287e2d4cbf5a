//! Steps a world and reads its grains: the columns in which the state stands.
//!
//! ```sh
//! cargo run -p grainfall-core --example read_grains
//! ```

use grainfall::scene::Scene;
use grainfall::solver::{Solver, advise};
use grainfall::world;
use std::error::Error;

/// Steps between two looks.
const STEPS: u64 = 2000;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::open("bouncing-grain")?;
    let mut world = world::build(&scene, advise(&scene).time_step);
    let mut solver = Solver::new(1);
    println!("time [s], grain, height [mm], speed [m/s], contacts");
    for _ in 0..10 {
        solver.advance(&mut world, STEPS)?;
        let grains = &world.grains;
        for grain in 0..grains.len() {
            let height = 1e3 * grains.position[grain].y;
            let speed = grains.velocity[grain].length();
            let contacts = grains.contact_count[grain];
            println!(
                "{:.4}, {grain}, {height:.3}, {speed:.4}, {contacts}",
                world.time()
            );
        }
    }
    println!("state {}", world.hash());
    Ok(())
}
