//! Where solves wait: one thread works on them, one at a time, each on all cores. A request of a
//! page replaces its older ones, and what nobody waits for is stopped.

use crate::base::Result;
use crate::base::stop::stoppable;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use tokio::sync::oneshot;

/// Most requests that wait.
const MOST_WAITING: usize = 16;

/// What a request asks for.
pub type Task = Box<dyn FnOnce() -> Result<Vec<u8>> + Send>;

/// Why a request has no solution.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Refusal {
    /// A newer one of the same page has replaced it.
    Replaced,
    /// Too many wait.
    Busy,
    /// What the calculation says, in the words of the command line.
    Failed(String),
    /// A fault of the program.
    Fault,
}

/// Whose request it is: the page, and how many it made before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Turn {
    /// The page's own name.
    pub page: String,
    /// Counts the states of the page: requests about one state do not replace each other.
    pub state: u64,
}

struct Job {
    turn: Turn,
    task: Task,
    stop: Arc<AtomicBool>,
    answer: oneshot::Sender<std::result::Result<Vec<u8>, Refusal>>,
}

#[derive(Default)]
struct Queue {
    waiting: VecDeque<Job>,
    /// The request that is being solved.
    current: Option<(Turn, Arc<AtomicBool>)>,
    closed: bool,
}

/// The waiting solves and the thread that works on them.
#[derive(Clone, Default)]
pub struct Desk {
    queue: Arc<(Mutex<Queue>, Condvar)>,
}

/// An answer to wait for. Dropping it stops the calculation.
pub struct Pending {
    answer: oneshot::Receiver<std::result::Result<Vec<u8>, Refusal>>,
    stop: Arc<AtomicBool>,
}

impl Drop for Pending {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

impl Pending {
    /// The answer.
    pub async fn answer(mut self) -> std::result::Result<Vec<u8>, Refusal> {
        // A request that is replaced while it waits is dropped without an answer.
        (&mut self.answer).await.unwrap_or(Err(Refusal::Replaced))
    }
}

impl Desk {
    /// A desk with its thread.
    pub fn open() -> Self {
        let desk = Self::default();
        let own = desk.clone();
        std::thread::Builder::new()
            .name("solves".into())
            .spawn(move || while own.work() {})
            .expect("the system has a thread");
        desk
    }

    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.0.lock().unwrap_or_else(|e| e.into_inner())
    }

    /// Puts a request at the end of the queue, in place of older ones of its page.
    ///
    /// # Errors
    /// [`Refusal::Busy`] if too many wait.
    pub fn ask(&self, turn: Turn, task: Task) -> std::result::Result<Pending, Refusal> {
        let (sender, answer) = oneshot::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let mut queue = self.queue();
        let replaced = |old: &Turn| old.page == turn.page && old.state < turn.state;
        queue.waiting.retain(|job| !replaced(&job.turn) && !job.answer.is_closed());
        if let Some((current, stop)) = &queue.current
            && replaced(current)
        {
            stop.store(true, Ordering::Relaxed);
        }
        if queue.waiting.len() >= MOST_WAITING {
            return Err(Refusal::Busy);
        }
        queue.waiting.push_back(Job { turn, task, stop: stop.clone(), answer: sender });
        self.queue.1.notify_one();
        Ok(Pending { answer, stop })
    }

    /// Whether nothing waits and nothing is being solved.
    #[cfg(test)]
    pub fn is_idle(&self) -> bool {
        let queue = self.queue();
        queue.waiting.is_empty() && queue.current.is_none()
    }

    /// Stops what is being solved, and takes no more.
    pub fn close(&self) {
        let mut queue = self.queue();
        queue.closed = true;
        queue.waiting.clear();
        if let Some((_, stop)) = &queue.current {
            stop.store(true, Ordering::Relaxed);
        }
        self.queue.1.notify_one();
    }

    /// Waits for a request and answers it; false once the desk is closed.
    fn work(&self) -> bool {
        let mut queue = self.queue();
        let job = loop {
            if queue.closed {
                return false;
            }
            match queue.waiting.pop_front() {
                Some(job) => break job,
                None => queue = self.queue.1.wait(queue).unwrap_or_else(|e| e.into_inner()),
            }
        };
        queue.current = Some((job.turn, job.stop.clone()));
        drop(queue);
        let task = AssertUnwindSafe(|| stoppable(&job.stop, job.task));
        let found = match catch_unwind(task) {
            _ if job.stop.load(Ordering::Relaxed) => Err(Refusal::Replaced),
            Ok(Ok(bytes)) => Ok(bytes),
            Ok(Err(e)) => Err(Refusal::Failed(e.to_string())),
            Err(_) => Err(Refusal::Fault),
        };
        self.queue().current = None;
        // Nobody may be waiting any more.
        let _ = job.answer.send(found);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::stop::go_on;
    use std::sync::mpsc;
    use std::time::{Duration, Instant};

    fn turn(page: &str, state: u64) -> Turn {
        Turn { page: page.into(), state }
    }

    fn answered(pending: Pending) -> std::result::Result<Vec<u8>, Refusal> {
        tokio::runtime::Builder::new_current_thread().build().unwrap().block_on(pending.answer())
    }

    /// A task that tells when it begins, and goes on until it is stopped.
    fn endless(begun: mpsc::Sender<()>) -> Task {
        Box::new(move || {
            begun.send(()).unwrap();
            loop {
                go_on()?;
                std::thread::sleep(Duration::from_millis(1));
            }
        })
    }

    fn idle(desk: &Desk) {
        let until = Instant::now() + Duration::from_secs(10);
        while !desk.is_idle() {
            assert!(Instant::now() < until, "something is still being solved");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_newer_request_replaces_those_before_it() {
        let desk = Desk::open();
        let (begun, begins) = mpsc::channel();
        let first = desk.ask(turn("a", 1), endless(begun)).unwrap();
        begins.recv().unwrap();
        let waiting = desk.ask(turn("a", 1), Box::new(|| Ok(vec![1]))).unwrap();
        let other = desk.ask(turn("b", 1), Box::new(|| Ok(vec![2]))).unwrap();
        let newest = desk.ask(turn("a", 2), Box::new(|| Ok(vec![3]))).unwrap();
        assert_eq!(answered(first), Err(Refusal::Replaced));
        assert_eq!(answered(waiting), Err(Refusal::Replaced));
        assert_eq!(answered(newest), Ok(vec![3]));
        assert_eq!(answered(other), Ok(vec![2]), "another page's stays");
    }

    #[test]
    fn what_nobody_waits_for_is_stopped() {
        let desk = Desk::open();
        let (begun, begins) = mpsc::channel();
        let pending = desk.ask(turn("a", 1), endless(begun.clone())).unwrap();
        begins.recv().unwrap();
        drop(pending);
        idle(&desk);
        let _kept = desk.ask(turn("a", 1), endless(begun)).unwrap();
        begins.recv().unwrap();
        desk.close();
        idle(&desk);
    }

    #[test]
    fn the_queue_is_limited_and_survives_a_fault() {
        let desk = Desk::open();
        let fault =
            desk.ask(turn("a", 1), Box::new(|| panic!("a fault that the test makes"))).unwrap();
        assert_eq!(answered(fault), Err(Refusal::Fault));
        let (begun, begins) = mpsc::channel();
        let _first = desk.ask(turn("a", 1), endless(begun)).unwrap();
        begins.recv().unwrap();
        let kept: Vec<_> = (0..MOST_WAITING)
            .map(|_| desk.ask(turn("b", 1), Box::new(|| Ok(vec![]))).unwrap())
            .collect();
        assert_eq!(desk.ask(turn("c", 1), Box::new(|| Ok(vec![]))).err(), Some(Refusal::Busy));
        drop(kept);
        assert!(desk.ask(turn("c", 1), Box::new(|| Ok(vec![]))).is_ok(), "room again");
        desk.close();
    }
}
