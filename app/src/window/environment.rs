//! What a window needs of the machine: a display that answers and a graphics driver.
//!
//! In: the environment. Out: what is found, or an error that says which is missing, how to get it
//! and how to do without. Asking here first is kinder than the panics of the libraries that would
//! otherwise find out.

use bevy::render::settings::Backends;
use bevy::tasks::block_on;
use std::fmt;
use std::path::{Path, PathBuf};

/// What is missing for a window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Missing {
    /// No display: the text says what was tried.
    Display(String),
    /// No graphics driver.
    Driver,
    /// The window system's libraries did not do their work: the text says what they said.
    Libraries(String),
}

impl std::error::Error for Missing {}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Display(tried) => {
                writeln!(f, "there is no display to open a window on: {tried}.")?;
                writeln!(
                    f,
                    "  On a desktop: start it from a terminal of that desktop."
                )?;
                writeln!(f, "  Over ssh: log in with `ssh -X`.")?;
                writeln!(
                    f,
                    "  With no screen at all: install xvfb (Debian, Ubuntu: `sudo apt install xvfb`; Fedora: `sudo dnf \
                     install xorg-x11-server-Xvfb`; Arch: `sudo pacman -S xorg-server-xvfb`) and put `xvfb-run` before \
                     the command."
                )?;
            }
            Self::Driver => {
                writeln!(f, "no Vulkan driver was found, so nothing can be drawn.")?;
                writeln!(
                    f,
                    "  Debian, Ubuntu: `sudo apt install libvulkan1 mesa-vulkan-drivers` (NVIDIA: the package \
                     nvidia-driver)"
                )?;
                writeln!(
                    f,
                    "  Fedora: `sudo dnf install vulkan-loader mesa-vulkan-drivers`"
                )?;
                writeln!(
                    f,
                    "  Arch: `sudo pacman -S vulkan-icd-loader` and vulkan-radeon, vulkan-intel, nvidia-utils or, for \
                     any machine, vulkan-swrast"
                )?;
                writeln!(
                    f,
                    "  Mesa's package holds a software driver too: it works without a graphics card, slowly."
                )?;
            }
            Self::Libraries(said) => {
                writeln!(f, "the window could not be opened: {said}.")?;
                writeln!(
                    f,
                    "  Debian, Ubuntu: `sudo apt install libx11-6 libx11-xcb1 libxcursor1 libxi6 libxrandr2 \
                     libxkbcommon-x11-0 libwayland-client0`"
                )?;
                writeln!(
                    f,
                    "  Fedora: `sudo dnf install libX11 libX11-xcb libXcursor libXi libXrandr libxkbcommon-x11 \
                     libwayland-client`"
                )?;
                writeln!(
                    f,
                    "  Arch: `sudo pacman -S libx11 libxcursor libxi libxrandr libxkbcommon-x11 wayland`"
                )?;
            }
        }
        write!(f, "  Without a window: add `--no-render`.")
    }
}

/// A way to draw.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adapter {
    /// What the driver calls it.
    pub name: String,
    /// Whether the processor does the drawing.
    pub software: bool,
}

/// All ways to draw that this machine's drivers offer.
pub fn adapters() -> Vec<Adapter> {
    let backends = Backends::from_env().unwrap_or(Backends::all());
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    let instance = wgpu::Instance::new(descriptor);
    let found = block_on(instance.enumerate_adapters(backends));
    found
        .iter()
        .map(|adapter| {
            let info = adapter.get_info();
            Adapter {
                name: info.name,
                software: info.device_type == wgpu::DeviceType::Cpu,
            }
        })
        .collect()
}

/// A display that answers, or what was tried.
///
/// # Errors
/// [`Missing::Display`] where neither `WAYLAND_DISPLAY` nor `DISPLAY` leads to one. Systems whose
/// windows need neither always have one.
pub fn display() -> Result<(), Missing> {
    if cfg!(not(unix)) || cfg!(target_os = "macos") {
        return Ok(());
    }
    // One that is no text names no display that could be asked.
    let variable = |name| std::env::var(name).ok().filter(|value| !value.is_empty());
    let runtime = variable("XDG_RUNTIME_DIR").map(PathBuf::from);
    let mut tried = Vec::new();
    if let Some(name) = variable("WAYLAND_DISPLAY") {
        if wayland_answers(&name, runtime.as_deref()) {
            return Ok(());
        }
        tried.push(format!("nothing answers at WAYLAND_DISPLAY={name}"));
    }
    if let Some(name) = variable("DISPLAY") {
        if x11_answers(&name) {
            return Ok(());
        }
        tried.push(format!("nothing answers at DISPLAY={name}"));
    }
    if tried.is_empty() {
        tried.push("neither WAYLAND_DISPLAY nor DISPLAY is set".to_owned());
    }
    Err(Missing::Display(tried.join(", and ")))
}

/// Whether the socket that `WAYLAND_DISPLAY` names can be connected to.
fn wayland_answers(name: &str, runtime: Option<&Path>) -> bool {
    let path = Path::new(name);
    if path.is_absolute() {
        socket_answers(path)
    } else {
        runtime.is_some_and(|runtime| socket_answers(&runtime.join(path)))
    }
}

/// Whether an X server listens where `DISPLAY` (`host:number.screen`) says.
fn x11_answers(name: &str) -> bool {
    if name.starts_with('/') {
        return socket_answers(Path::new(name));
    }
    let Some((host, display)) = name.rsplit_once(':') else {
        return false;
    };
    let number = display.split('.').next().unwrap_or_default();
    let Ok(number) = number.parse::<u16>() else {
        return false;
    };
    let local = host.is_empty() || host == "unix";
    if local {
        let path = format!("/tmp/.X11-unix/X{number}");
        socket_answers(Path::new(&path)) || abstract_socket_answers(&path)
    } else {
        let Some(port) = number.checked_add(6000) else {
            return false;
        };
        std::net::TcpStream::connect((host, port)).is_ok()
    }
}

#[cfg(unix)]
fn socket_answers(path: &Path) -> bool {
    std::os::unix::net::UnixStream::connect(path).is_ok()
}

#[cfg(not(unix))]
fn socket_answers(_path: &Path) -> bool {
    false
}

#[cfg(target_os = "linux")]
fn abstract_socket_answers(path: &str) -> bool {
    use std::os::linux::net::SocketAddrExt;
    use std::os::unix::net::{SocketAddr, UnixStream};
    SocketAddr::from_abstract_name(path).is_ok_and(|at| UnixStream::connect_addr(&at).is_ok())
}

#[cfg(not(target_os = "linux"))]
fn abstract_socket_answers(_path: &str) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absent_or_malformed_displays_do_not_answer() {
        for name in [
            "",
            "nonsense",
            ":",
            ":x",
            ":65001",
            "host.invalid:0",
            ":60999.0",
            "/no/such/socket",
        ] {
            assert!(!x11_answers(name), "{name}");
        }
        assert!(!wayland_answers(
            "wayland-77",
            Some(Path::new("/no/such/folder"))
        ));
        assert!(!wayland_answers("wayland-77", None));
    }

    #[cfg(unix)]
    #[test]
    fn listening_socket_answers() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("wayland-3");
        let _listener = std::os::unix::net::UnixListener::bind(&path).unwrap();
        assert!(wayland_answers("wayland-3", Some(folder.path())));
        assert!(wayland_answers(path.to_str().unwrap(), None));
        assert!(x11_answers(path.to_str().unwrap()));
    }

    #[test]
    fn every_message_says_how_to_do_without_a_window() {
        for missing in [
            Missing::Display("neither is set".to_owned()),
            Missing::Driver,
            Missing::Libraries("it failed".to_owned()),
        ] {
            let message = missing.to_string();
            assert!(message.contains("--no-render"), "{message}");
            assert!(message.contains("apt install"), "{message}");
        }
    }
}
