//! Where pictures are drawn: a thread of its own, so that the window never waits.

use super::exhibit::Exhibit;
use super::look::{Fineness, Frame, Look};
use crate::render::Place;
use crate::visibility::{EngineChoice, VisibilityError, build};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// The first picture of a look that moves takes no longer than this, if fewer rays can help ...
const SLOW: Duration = Duration::from_millis(90);
/// ... and has more rays if it takes less than this.
const FAST: Duration = Duration::from_millis(25);
/// The coarsest pictures: one ray for a square of pixels with this side.
const COARSEST: u32 = 8;

/// Who a picture goes to, or the reason why there is none.
type Deliver = dyn Fn(Result<Frame, VisibilityError>) + Send;

/// Draws the look that was asked for last: at first as coarsely as it takes to follow a hand, then every pixel, then in full.
pub struct Studio {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    engine: EngineChoice,
    /// What was asked for last; nothing at the end.
    order: Mutex<Option<Order>>,
    /// Counts the orders.
    number: AtomicU64,
    changed: Condvar,
}

#[derive(Clone)]
struct Order {
    exhibit: Arc<Exhibit>,
    look: Look,
}

impl Studio {
    /// Begins with a look; `deliver` is called in the studio's thread with every picture.
    pub fn new(
        engine: EngineChoice,
        exhibit: Arc<Exhibit>,
        look: Look,
        deliver: impl Fn(Result<Frame, VisibilityError>) + Send + 'static,
    ) -> Self {
        let shared = Arc::new(Shared {
            engine,
            order: Mutex::new(Some(Order { exhibit, look })),
            number: AtomicU64::new(1),
            changed: Condvar::new(),
        });
        let theirs = shared.clone();
        let thread = std::thread::spawn(move || theirs.work(&deliver));
        Self {
            shared,
            thread: Some(thread),
        }
    }

    /// Asks for another look, or another exhibit, in place of what was asked for before.
    pub fn ask(&self, exhibit: Arc<Exhibit>, look: Look) {
        self.shared.ask(Some(Order { exhibit, look }));
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        self.shared.ask(None);
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has said so.
            let _ = thread.join();
        }
    }
}

impl Shared {
    fn ask(&self, order: Option<Order>) {
        *self.lock() = order;
        self.number.fetch_add(1, Ordering::SeqCst);
        self.changed.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, Option<Order>> {
        self.order.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for an order with another number than `done`.
    fn next(&self, done: u64) -> Option<(u64, Order)> {
        let mut order = self.lock();
        while self.number.load(Ordering::SeqCst) == done {
            order = self
                .changed
                .wait(order)
                .unwrap_or_else(PoisonError::into_inner);
        }
        Some((self.number.load(Ordering::SeqCst), order.clone()?))
    }

    fn work(&self, deliver: &Deliver) {
        let mut artist = Artist {
            shared: self,
            deliver,
            side: COARSEST / 2,
            stood: None,
        };
        let mut next = self.next(0);
        while let Some((number, order)) = next {
            next = artist.serve(number, order);
        }
    }
}

/// Draws order after order.
struct Artist<'a> {
    shared: &'a Shared,
    deliver: &'a Deliver,
    /// Of the coarse pictures' squares.
    side: u32,
    /// The look before.
    stood: Option<Look>,
}

impl Artist<'_> {
    /// Serves all orders for one exhibit; gives back the first for another.
    fn serve(&mut self, mut number: u64, mut order: Order) -> Option<(u64, Order)> {
        let exhibit = order.exhibit.clone();
        let mut place: Option<Place> = None;
        while Arc::ptr_eq(&order.exhibit, &exhibit) {
            let eye = order.look.camera.eye;
            if place.as_ref().is_none_or(|place| place.eye() != eye) {
                let engine = |triangles| build(self.shared.engine, &triangles, 0);
                // Of an engine that fails no place remains: the one before is elsewhere.
                place = match Place::new(&exhibit.lit, eye, engine) {
                    Ok(made) => Some(made),
                    Err(error) => {
                        (self.deliver)(Err(error));
                        None
                    }
                };
            }
            if let Some(place) = &place {
                self.draw(number, &order, place);
            }
            (number, order) = self.shared.next(number)?;
        }
        Some((number, order))
    }

    /// The first picture is always finished: who moves fast would see none otherwise. The others give way to new orders.
    fn draw(&mut self, number: u64, order: &Order, place: &Place) {
        let (look, exhibit) = (&order.look, &order.exhibit);
        let wanted = || self.shared.number.load(Ordering::SeqCst) == number;
        // Where only the light has changed, squares would flicker.
        let side = match self.stood.as_ref() == Some(look) {
            true => 1,
            false => self.side,
        };
        let started = Instant::now();
        if let Some(frame) = look.draw(exhibit, place, Fineness::Coarse(side), &|| true) {
            (self.deliver)(Ok(frame));
        }
        let took = started.elapsed();
        let finer = [Fineness::Coarse(1), Fineness::Full];
        for fineness in &finer[usize::from(side == 1)..] {
            if let Some(frame) = look.draw(exhibit, place, *fineness, &wanted) {
                (self.deliver)(Ok(frame));
            }
        }
        self.stood = Some(look.clone());
        self.adapt(side, took);
    }

    fn adapt(&mut self, side: u32, took: Duration) {
        if side == self.side {
            self.side = match took {
                slow if slow > SLOW => (side + 1).min(COARSEST),
                fast if fast < FAST => (side - 1).max(1),
                _ => side,
            };
        }
    }
}
