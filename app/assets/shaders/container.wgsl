// Walls: tinted panes with fine lines, so that one sees both the wall and how it moves.

#import bevy_pbr::forward_io::VertexOutput
#import bevy_pbr::mesh_view_bindings::view
#import grainfall::light::{matt_light, gloss}

struct Look {
    // Linear colour and opacity of the pane, of its lines and of the mark.
    surface: vec4<f32>,
    line: vec4<f32>,
    mark: vec4<f32>,
    // Distance at which a grid has faded away, in cells.
    fade: f32,
    // Radius of the circle that is marked on a floor, in cells.
    circle: f32,
    unused: vec2<f32>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> look: Look;

// The pattern is a definition, not a number in `Look`: some drivers compile a shader anew whenever a number that decides a
// branch is handed over. What `uv` means under each:
// PLATE: place on the unit disc.
// RIM: turns round the axis, place along it from back (0) to front (1).
// GRID: place in cells.
// HOOP: turns round the axis, place from the inside (0) to the outside (1).
// RINGS: place in cells, from the axis.

const SPOKES: f32 = 12.0;
const TURN: f32 = 6.2831853;

// How much of a line of this half width is at distance `d` from its middle; at least a pixel wide.
fn line(d: f32, half_width: f32) -> f32 {
    let pixel = fwidth(d);
    let half = max(half_width, 0.6 * pixel);
    let strength = min(half_width / half + 0.35, 1.0);
    return strength * (1.0 - smoothstep(half - 0.6 * pixel, half + 0.6 * pixel, abs(d)));
}

// Distance from the nearest integer.
fn from_integer(x: f32) -> f32 {
    return abs(fract(x + 0.5) - 0.5);
}

fn plate(place: vec2<f32>) -> vec2<f32> {
    let radius = length(place);
    // Distance from the nearest of the spokes, all of which are lines through the middle.
    let angle = atan2(place.y, place.x);
    let spoke = sin(from_integer(angle / TURN * SPOKES) * TURN / SPOKES) * radius;
    let spokes = line(spoke, 0.0022) * smoothstep(0.16, 0.24, radius);
    let rings = max(line(radius - 0.2, 0.0022), line(radius - 0.6, 0.0018));
    // The mark: a bold spoke towards the mark on the hoop.
    let mark = line(place.y, 0.007) * smoothstep(0.19, 0.2, place.x);
    return vec2<f32>(max(spokes, rings), mark);
}

fn rim(place: vec2<f32>) -> vec2<f32> {
    let slat = from_integer(place.x * SPOKES);
    let ends = min(place.y, 1.0 - place.y);
    let mark = line(from_integer(place.x) * SPOKES, 0.05);
    return vec2<f32>(max(line(slat, 0.008), line(ends, 0.012)), mark);
}

fn grid(place: vec2<f32>) -> f32 {
    let fine = max(line(from_integer(place.x), 0.012), line(from_integer(place.y), 0.012));
    let bold = max(line(5.0 * from_integer(place.x / 5.0), 0.02), line(5.0 * from_integer(place.y / 5.0), 0.02));
    return max(0.45 * fine, bold);
}

fn rings(place: vec2<f32>) -> vec2<f32> {
    let radius = length(place);
    let fine = line(from_integer(radius), 0.012);
    let bold = max(line(5.0 * from_integer(radius / 5.0), 0.02), line(place.x, 0.012));
    return vec2<f32>(max(0.45 * fine, max(bold, line(place.y, 0.012))), line(radius - look.circle, 0.03));
}

fn hoop(place: vec2<f32>) -> vec2<f32> {
    let ticks = line(from_integer(place.x * SPOKES * 6.0), 0.05) * step(place.y, 0.3);
    let bold = line(from_integer(place.x * SPOKES), 0.018) * step(place.y, 0.62);
    let mark = step(from_integer(place.x), 0.006 * (1.0 - 0.75 * place.y));
    return vec2<f32>(max(ticks, bold), mark);
}

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    // x: of the lines, y: of the mark.
    var drawn = vec2<f32>(0.0);
#ifdef PLATE
    drawn = plate(in.uv);
#endif
#ifdef RIM
    drawn = rim(in.uv);
#endif
#ifdef GRID
    drawn.x = grid(in.uv);
#endif
#ifdef HOOP
    drawn = hoop(in.uv);
#endif
#ifdef RINGS
    drawn = rings(in.uv);
#endif
    let veil = 1.0 - smoothstep(0.25 * look.fade, look.fade, length(in.uv));
    let to_eye = normalize(view.world_position - in.world_position.xyz);
    let normal = normalize(in.world_normal) * select(-1.0, 1.0, front);
    let pane = vec4<f32>(look.surface.rgb * matt_light(normal) + 0.05 * gloss(normal, to_eye), look.surface.a);
    var colour = mix(pane, vec4<f32>(look.line.rgb, max(look.line.a, pane.a)), drawn.x);
    colour = mix(colour, vec4<f32>(look.mark.rgb, max(look.mark.a, pane.a)), drawn.y);
    return vec4<f32>(colour.rgb, colour.a * veil);
}
