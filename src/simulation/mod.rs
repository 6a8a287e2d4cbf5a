//! A run and the Bevy plugin that steps it.
