//! Pages that are open: each holds one answer that never ends. When the last one has gone, so does
//! the explorer.

use hyper::body::{Body, Bytes, Frame};
use std::convert::Infallible;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::sync::Notify;
use tokio::time::{Interval, interval};

/// How often an open page is told that the program is there.
const BEAT: Duration = Duration::from_secs(5);

/// How long the last page may be away: a page that is loaded again comes back sooner.
const GRACE: Duration = Duration::from_secs(3);

/// The pages that are open.
#[derive(Clone, Default)]
pub struct Pages {
    shared: Arc<(AtomicUsize, Notify)>,
}

impl Pages {
    /// An answer for a page, which counts as open as long as it takes it.
    pub fn opened(&self) -> Alive {
        self.shared.0.fetch_add(1, Ordering::SeqCst);
        Alive { pages: self.clone(), beat: interval(BEAT) }
    }

    fn open(&self) -> usize {
        self.shared.0.load(Ordering::SeqCst)
    }

    /// Waits until there were pages and all of them have been closed.
    pub async fn all_closed(&self) {
        loop {
            self.shared.1.notified().await;
            if self.open() == 0 {
                tokio::time::sleep(GRACE).await;
                if self.open() == 0 {
                    return;
                }
            }
        }
    }
}

/// The answer that an open page holds.
pub struct Alive {
    pages: Pages,
    beat: Interval,
}

impl Drop for Alive {
    fn drop(&mut self) {
        self.pages.shared.0.fetch_sub(1, Ordering::SeqCst);
        self.pages.shared.1.notify_one();
    }
}

impl Body for Alive {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        // A comment of an event stream.
        self.beat.poll_tick(context).map(|_| Some(Ok(Frame::data(Bytes::from_static(b":\n\n")))))
    }
}
