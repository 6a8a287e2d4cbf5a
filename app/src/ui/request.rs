//! What panels ask for. Panels change nothing themselves but how the picture is drawn: they push
//! requests, and one function ([`super::dispatch`]) fulfils them.

use crate::ui::arrangement::Rearrangement;
use crate::ui::plot_export::Export;
use crate::ui::screenshot_orders::{PictureOf, ScreenshotOrder};
use crate::view::CameraRequest;
use bevy::prelude::*;
use grainfall::lab::Half;
use grainfall::lesson::Prediction;
use grainfall::parameters::{Parameter, Value};
use grainfall::run::Command;
use grainfall::scene::Scene;
use grainfall::sweep::{Case, Question};
use std::path::PathBuf;

/// Something a person asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// A change of the run.
    Command(Command),
    /// Show the panel where two values are compared: of this parameter, where one is given.
    Compare(Option<Parameter>),
    /// Something about a parameter sweep.
    Sweep(SweepAct),
    /// Begin a run beside the present one, with another value of a parameter.
    StartComparison(Parameter, Value),
    /// Another value of a parameter in one of two runs.
    SetIn(Half, Parameter, Value),
    /// Go on with one of two runs, and keep the other as a branch of it.
    EndComparison(Half),
    /// Call a run by this name, or by what differs in it where the name is empty.
    NameRun {
        /// In whose list of runs it is.
        half: Half,
        /// Its number there.
        number: u32,
        /// The name.
        name: String,
    },
    /// Let the person type the name of the run that is shown.
    TypeName,
    /// Let the person type the moment to go to.
    TypeMoment,
    /// Mark the moment shown as an end of the part that is played again and again; the third time
    /// play on without that.
    Repeat,
    /// Take the ruler out, or put it away.
    Ruler,
    /// Draw the trail of the selected grain, or no longer.
    Trail,
    /// Draw no trails.
    NoTrails,
    /// Another view of the scene.
    Camera(CameraRequest),
    /// Show the scenes that come with the program.
    ShowScenes,
    /// Something about the lesson that is followed.
    Lesson(LessonAct),
    /// Let the person choose a file of a scene, a lesson, a session or a recording.
    ChooseFile,
    /// Open this: the path of a scene, a lesson, a session or a recording, or the name of a built-in
    /// scene or lesson.
    Open(String),
    /// Start afresh with this scene in place of the present one, and the present values of the live
    /// parameters.
    Start(Box<Scene>),
    /// Start a run of the scene of the recording that is shown, with the values of that moment.
    RunAnew,
    /// Start a run with the grains of the recording as they are at the moment shown.
    RunOn,
    /// Measure the mean flow of the recording that is shown on its states.
    MeasureFlow,
    /// Write the whole session to the file it has, or let the person choose one.
    Save,
    /// Let the person choose where the whole session goes.
    ChooseSession,
    /// Write the whole session to this file.
    SaveSession(PathBuf),
    /// Save, and when that has succeeded do this, which leaves the session.
    SaveThen(Box<Request>),
    /// Do this though something speaks against it.
    Anyway(Box<Request>),
    /// Open the session that an earlier window left, as work that is in no file.
    OpenLeft(PathBuf),
    /// Remove the session that an earlier window left.
    DiscardLeft(PathBuf),
    /// Do this, which leaves the session, without asking.
    Leave(Box<Request>),
    /// Let the person choose where the list of changes goes.
    ChooseChanges,
    /// Write the changes of the present run to this file.
    SaveChanges(PathBuf),
    /// Let the person choose where a picture of this goes and how large it is.
    ChoosePicture(PictureOf),
    /// Let the person choose where this plot goes.
    ExportPlot(Box<Export>),
    /// Write the plot that was asked for to this file: SVG, PNG or CSV, as its ending says.
    SavePlot(PathBuf),
    /// Let the person choose where a film goes and what it is like; end and keep the one that is
    /// being recorded.
    ChooseFilm,
    /// Take a picture or a film, or end one.
    Screenshot(ScreenshotOrder),
    /// Show a sheet over the window.
    Show(Sheet),
    /// The keyboard's focus into the menu bar.
    Menus,
    /// Another place for a panel.
    Arrange(Rearrangement),
    /// Panels away and numbers that are read from afar, or back.
    Present,
    /// The window over the whole screen, or back.
    FullScreen,
    /// End the program.
    Quit,
}

impl Request {
    /// Whether it gives a parameter a value: what is set while one drag lasts is one change.
    pub(super) fn sets_a_value(&self) -> bool {
        matches!(self, Self::Command(Command::Set { .. }) | Self::SetIn(..))
    }

    /// Whether it changes the run, or takes it to another moment.
    pub(super) fn moves_the_run(&self) -> bool {
        matches!(
            self,
            Self::Command(_)
                | Self::StartComparison(..)
                | Self::SetIn(..)
                | Self::EndComparison(_)
                | Self::Lesson(_)
        )
    }

    /// Whether it takes a run: what a recording is not asked for.
    pub(super) fn takes_a_run(&self) -> bool {
        match self {
            Self::Command(command) => matches!(
                command,
                Command::Set { .. }
                    | Command::Undo
                    | Command::Redo
                    | Command::Return(_)
                    | Command::Forget(_)
            ),
            Self::Compare(_)
            | Self::StartComparison(..)
            | Self::SetIn(..)
            | Self::EndComparison(_)
            | Self::NameRun { .. }
            | Self::TypeName
            | Self::Save
            | Self::ChooseSession
            | Self::SaveSession(_)
            | Self::ChooseChanges
            | Self::SaveChanges(_) => true,
            _ => false,
        }
    }
}

/// What is asked of parameter sweeps.
#[derive(Clone, Debug, PartialEq)]
pub enum SweepAct {
    /// Show their panel: of this parameter, where one is given.
    Ask(Option<Parameter>),
    /// Run the sweep that answers this, or go on with it, in the background.
    Start(Box<Question>),
    /// Stop the sweep; what is done is kept.
    Stop,
    /// Let the person choose the folder of sweeps.
    ChooseFolder,
    /// Put the sweeps that follow into this folder.
    Folder(PathBuf),
    /// Start afresh with this case of a sweep in place of the present run.
    Open(Box<Case>),
}

/// What is asked of the lesson that is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LessonAct {
    /// What comes next: the field, the experiment, the next step.
    Main,
    /// The next step.
    Next,
    /// The step before.
    Back,
    /// One hint more.
    Hint,
    /// This is the prediction.
    Say(Prediction),
    /// Forget what was predicted and measured in this step.
    Again,
    /// Follow it no longer.
    Leave,
}

/// A sheet of text over the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sheet {
    /// Keys and what they do.
    Shortcuts,
    /// What the program is.
    About,
}

/// What has been asked for and not yet fulfilled.
#[derive(Resource, Default)]
pub struct Requests(pub(super) Vec<Request>);

impl Requests {
    /// Asks for `request`, as a panel would.
    pub fn ask(&mut self, request: Request) {
        self.0.push(request);
    }
}
