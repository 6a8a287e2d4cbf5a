//! Lessons: a scene in steps of text, with predictions that a run then answers.
//!
//! In: a lesson's file, then what a person predicts and what a run measured. Out: the step under
//! way, the commands that play its experiment, and a verdict by the measured quantity with its
//! error. Nothing here draws, and nothing here changes a run: commands are handed out.
//!
//! Each row of the table uses only rows below it; a test holds the files to that.
//!
//! | file | holds |
//! |---|---|
//! | `under_way` | a lesson while somebody follows it; how a session keeps it |
//! | `reading` | lessons from files and from the program: the one door |
//! | `check` | which lessons make sense, alone and with their scene |
//! | `file` | the keys of a lesson's file |
//! | `built_in` | the lessons that come with the program |
//! | `experiment` | the commands that play a step, and when its run has answered |
//! | `verdict` | what a prediction and a measurement come to, in words |
//! | `description` | a lesson as plain data, and what it measures |
//!
#![doc = include_str!("../../docs/lessons.md")]

mod built_in;
mod check;
mod description;
mod experiment;
mod file;
mod reading;
mod under_way;
mod verdict;

pub use built_in::{BuiltInLesson, built_in_lessons};
pub use description::{
    Change, Lesson, LessonCut, LessonLook, LessonStep, LessonView, Measurement, Prediction,
    Question, QuestionKind, RunScatter, Shown, Statistic, Touch,
};
pub use experiment::Seen;
pub use reading::LessonError;
pub use under_way::{Answer, LessonUnderWay, Stage};
pub use verdict::{Judged, judge, measured_change};
