//! Who moves the engine: the caller, or a thread of its own.
//!
//! In: [`Message`]s. Out: [`Update`]s. Inline, the work is done within [`Driver::tick`]. On a
//! thread, a tick grants the wall-clock time that has passed and returns at once; while the time
//! granted before is being worked on, nothing more is granted, so a machine slower than real time
//! slows simulated time down and never the caller. Dropping the driver ends the thread within a
//! piece. A driver decides nothing about the runs.

use super::engine::{Engine, Message};
use super::update::Update;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Shortest time between two updates from a thread.
const PUBLISHING_TIME: Duration = Duration::from_millis(15);
/// Most wall-clock time an inline tick works.
const INLINE_WORKING_TIME: Duration = Duration::from_millis(50);
/// Longest time between two updates of an inline run that is busy.
const INLINE_PUBLISHING_TIME: Duration = Duration::from_millis(250);
/// Most wall-clock time that ticks can save up while a thread is busy.
const MOST_SAVED_UP: Duration = Duration::from_millis(100);

/// Who moves the engine.
pub enum Driver {
    /// The caller.
    Inline {
        /// What is moved.
        engine: Box<Engine>,
        /// When the last update was taken.
        published: Instant,
    },
    /// A thread of its own.
    Thread(Threaded),
}

/// The caller's end of an engine on a thread.
pub struct Threaded {
    messages: Option<Sender<Message>>,
    exchange: Arc<Exchange>,
    thread: Option<JoinHandle<()>>,
    /// Wall-clock time that has passed and is not granted yet.
    accumulator: Duration,
}

/// What both ends share.
#[derive(Default)]
struct Exchange {
    update: Mutex<Option<Update>>,
    busy: AtomicBool,
}

impl Driver {
    /// The caller moves `engine`.
    pub fn inline(engine: Engine) -> Self {
        Self::Inline {
            engine: Box::new(engine),
            published: Instant::now(),
        }
    }

    /// A thread of its own moves the engine that `make` makes there.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn thread(make: impl FnOnce() -> Engine + Send + 'static) -> std::io::Result<Self> {
        let (sender, receiver) = channel();
        let exchange = Arc::new(Exchange::default());
        let shared = exchange.clone();
        let thread = std::thread::Builder::new()
            .name("solver".into())
            .spawn(move || run_thread(&mut make(), &receiver, &shared))?;
        Ok(Self::Thread(Threaded {
            messages: Some(sender),
            exchange,
            thread: Some(thread),
            accumulator: Duration::ZERO,
        }))
    }

    /// Passes `message` on to the engine.
    pub fn send(&mut self, message: Message) {
        match self {
            Self::Inline { engine, .. } => engine.take(message),
            Self::Thread(threaded) => {
                if let Some(messages) = &threaded.messages {
                    // Dropped where the thread has ended by a mistake, which `has_died` reports.
                    drop(messages.send(message));
                }
            }
        }
    }

    /// Lets `passed` wall-clock time pass and returns what is new.
    pub fn tick(&mut self, passed: Duration) -> Option<Update> {
        if let Self::Thread(threaded) = self
            && let Some(granted) = threaded.grant(passed)
        {
            self.send(Message::Tick(granted));
        }
        match self {
            Self::Inline { engine, published } => {
                engine.take(Message::Tick(passed));
                let started = Instant::now();
                while engine.is_busy() && started.elapsed() < INLINE_WORKING_TIME {
                    engine.work();
                }
                if engine.is_busy() && published.elapsed() < INLINE_PUBLISHING_TIME {
                    return None;
                }
                *published = Instant::now();
                Some(engine.take_update())
            }
            Self::Thread(threaded) => threaded.exchange.lock().take(),
        }
    }

    /// Whether the thread ended by itself, which only a mistake in the program brings about.
    pub fn has_died(&self) -> bool {
        match self {
            Self::Inline { .. } => false,
            Self::Thread(threaded) => threaded.thread.as_ref().is_none_or(JoinHandle::is_finished),
        }
    }
}

impl Threaded {
    /// The time to grant now that `passed` more has passed: nothing while the engine is busy.
    fn grant(&mut self, passed: Duration) -> Option<Duration> {
        self.accumulator = (self.accumulator + passed).min(MOST_SAVED_UP);
        let was_busy = self.exchange.busy.swap(true, Ordering::AcqRel);
        (!was_busy).then(|| std::mem::take(&mut self.accumulator))
    }
}

impl Drop for Threaded {
    fn drop(&mut self) {
        self.messages = None;
        if let Some(thread) = self.thread.take() {
            // Dropped because a thread that panicked has printed its panic, and there is nobody
            // left to tell.
            drop(thread.join());
        }
    }
}

impl Exchange {
    fn lock(&self) -> std::sync::MutexGuard<'_, Option<Update>> {
        self.update.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn publish(&self, update: Update) {
        let mut slot = self.lock();
        match slot.as_mut() {
            Some(earlier) => earlier.absorb(update),
            None => *slot = Some(update),
        }
    }
}

/// Works until the caller's end is gone.
fn run_thread(engine: &mut Engine, messages: &Receiver<Message>, exchange: &Exchange) {
    let mut published = Instant::now();
    loop {
        if engine.is_busy() {
            engine.work();
        } else {
            exchange.publish(engine.take_update());
            exchange.busy.store(false, Ordering::Release);
            match messages.recv() {
                Ok(message) => engine.take(message),
                Err(_) => return,
            }
        }
        loop {
            match messages.try_recv() {
                Ok(message) => engine.take(message),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => return,
            }
        }
        if published.elapsed() >= PUBLISHING_TIME {
            published = Instant::now();
            exchange.publish(engine.take_update());
        }
    }
}
