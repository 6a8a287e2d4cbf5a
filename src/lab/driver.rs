//! Who moves the engine: the caller, or a thread of its own.
//!
//! In: [`Order`]s. Out: [`Update`]s. Inline, the work is done within [`Driver::tick`]. On a thread, a tick hands the next
//! slice over and returns at once; while the last one is being worked on, nothing new is handed over, so a machine slower
//! than real time slows simulated time down and never the caller. Dropping the driver ends the thread within a piece.

use super::engine::{Engine, Order, Update};
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
const LONGEST_DEBT: Duration = Duration::from_millis(100);

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
    orders: Option<Sender<Order>>,
    exchange: Arc<Exchange>,
    thread: Option<JoinHandle<()>>,
    owed: Duration,
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
            orders: Some(sender),
            exchange,
            thread: Some(thread),
            owed: Duration::ZERO,
        }))
    }

    /// Passes `order` on.
    pub fn order(&mut self, order: Order) {
        match self {
            Self::Inline { engine, .. } => engine.order(order),
            Self::Thread(threaded) => threaded.order(order),
        }
    }

    /// Lets `passed` wall-clock time pass and returns what is new.
    pub fn tick(&mut self, passed: Duration) -> Option<Update> {
        match self {
            Self::Inline { engine, published } => {
                engine.order(Order::Tick(passed));
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
            Self::Thread(threaded) => threaded.tick(passed),
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
    fn order(&self, order: Order) {
        // A thread that ended hears nothing; `has_died` tells so.
        let _ = self.orders.as_ref().map(|orders| orders.send(order));
    }

    fn tick(&mut self, passed: Duration) -> Option<Update> {
        self.owed = (self.owed + passed).min(LONGEST_DEBT);
        if !self.exchange.busy.swap(true, Ordering::AcqRel) {
            let granted = std::mem::take(&mut self.owed);
            self.order(Order::Tick(granted));
        }
        self.exchange.lock().take()
    }
}

impl Drop for Threaded {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has told so on its own.
            let _ = thread.join();
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
fn run_thread(engine: &mut Engine, orders: &Receiver<Order>, exchange: &Exchange) {
    let mut published = Instant::now();
    loop {
        if engine.is_busy() {
            engine.work();
        } else {
            exchange.publish(engine.take_update());
            exchange.busy.store(false, Ordering::Release);
            match orders.recv() {
                Ok(order) => engine.order(order),
                Err(_) => return,
            }
        }
        loop {
            match orders.try_recv() {
                Ok(order) => engine.order(order),
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
