//! The windowless runner: progress, output files, exit codes.
