//! The window: events in, pictures out.

use super::exhibit::Exhibit;
use super::keys::{Wish, wish};
use super::look::Frame;
use super::reading::Reading;
use super::state::{Action, Viewer};
use super::studio::Studio;
use crate::visibility::{EngineChoice, VisibilityError};
use glam::DVec2;
use softbuffer::{Context, Surface};
use std::num::NonZeroU32;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use thiserror::Error;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{
    ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy, OwnedDisplayHandle,
};
use winit::keyboard::ModifiersState;
use winit::window::{Window as Frameless, WindowId};

/// How often the hooks are asked whether to close.
const POLL: Duration = Duration::from_millis(200);
/// A press that moved by no more pixels than this is a click.
const CLICK: f64 = 3.0;
/// Pixels of a touchpad's scrolling that count as a notch of a wheel.
const NOTCH: f64 = 40.0;

/// Why there is no window.
#[derive(Debug, Error)]
pub enum WindowError {
    /// Nowhere to show one.
    #[error("no window can be opened: {0}")]
    NoDisplay(String),
    /// It was there, and failed.
    #[error("the window failed: {0}")]
    Failed(String),
    /// What is to be shown cannot be traced.
    #[error(transparent)]
    Visibility(#[from] VisibilityError),
}

/// What happens outside the thread of the window.
enum Notice {
    Show(Arc<Exhibit>),
    Drawn(Result<Frame, VisibilityError>),
}

/// A window that is to be opened; there can be one in a process.
pub struct Window {
    events: EventLoop<Notice>,
    is_open: Arc<AtomicBool>,
}

/// The window, for other threads.
#[derive(Clone)]
pub struct Screen {
    proxy: EventLoopProxy<Notice>,
    is_open: Arc<AtomicBool>,
}

impl Screen {
    /// Shows something else.
    pub fn show(&self, exhibit: Exhibit) {
        // A window that is closed shows nothing.
        let _ = self.proxy.send_event(Notice::Show(Arc::new(exhibit)));
    }

    /// Whether there is still somebody to show things to.
    pub fn is_open(&self) -> bool {
        self.is_open.load(Ordering::SeqCst)
    }
}

/// What the window has to say to its owner.
pub struct Hooks<'a> {
    /// Somebody clicked on a point.
    pub read: &'a mut dyn FnMut(&Reading),
    /// Asked now and then: whether the window is to close.
    pub is_over: &'a dyn Fn() -> bool,
}

impl Window {
    /// Finds the display.
    ///
    /// # Errors
    /// When there is none.
    pub fn new() -> Result<Self, WindowError> {
        let events = EventLoop::with_user_event().build();
        Ok(Self {
            events: events.map_err(|error| WindowError::NoDisplay(reason(&error)))?,
            is_open: Arc::new(AtomicBool::new(true)),
        })
    }

    /// The same for other threads.
    pub fn screen(&self) -> Screen {
        Screen {
            proxy: self.events.create_proxy(),
            is_open: self.is_open.clone(),
        }
    }

    /// Shows `exhibit` as `viewer` wants it until somebody closes the window; has to be called by the main thread.
    ///
    /// # Errors
    /// When the window or the engine fails.
    pub fn run<'a>(
        self,
        title: &'a str,
        viewer: Viewer,
        exhibit: Exhibit,
        engine: EngineChoice,
        hooks: Hooks<'a>,
    ) -> Result<(), WindowError> {
        let (exhibit, proxy) = (Arc::new(exhibit), self.events.create_proxy());
        let studio = Studio::new(engine, exhibit.clone(), viewer.look(), move |drawn| {
            // A window that is closed shows nothing.
            let _ = proxy.send_event(Notice::Drawn(drawn));
        });
        let context = Context::new(self.events.owned_display_handle());
        let mut desk = Desk {
            title,
            viewer,
            exhibit,
            studio,
            hooks,
            context: context.map_err(failed)?,
            pane: None,
            frame: None,
            pointer: Pointer::default(),
            failure: None,
        };
        let ended = self.events.run_app(&mut desk);
        self.is_open.store(false, Ordering::SeqCst);
        match desk.failure {
            Some(error) => Err(error),
            None => ended.map_err(|error| WindowError::Failed(reason(&error))),
        }
    }
}

fn failed(error: impl std::fmt::Display) -> WindowError {
    WindowError::Failed(reason(&error))
}

/// A message in one line, without the place in winit's sources that it begins with.
fn reason(error: &impl std::fmt::Display) -> String {
    let text = error.to_string();
    let text = match text.strip_prefix("os error at ") {
        Some(placed) => placed.split_once(": ").map_or(placed, |(_, text)| text),
        None => &text,
    };
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The mouse and the keys that are held.
#[derive(Default)]
struct Pointer {
    at: DVec2,
    /// The button that is down, and where it went down.
    down: Option<(MouseButton, DVec2)>,
    modifiers: ModifiersState,
}

type Canvas = Surface<OwnedDisplayHandle, Rc<Frameless>>;

/// Everything around an open window.
struct Desk<'a> {
    title: &'a str,
    viewer: Viewer,
    exhibit: Arc<Exhibit>,
    studio: Studio,
    hooks: Hooks<'a>,
    context: Context<OwnedDisplayHandle>,
    pane: Option<(Rc<Frameless>, Canvas)>,
    frame: Option<Frame>,
    pointer: Pointer,
    failure: Option<WindowError>,
}

impl Desk<'_> {
    fn open(&self, events: &ActiveEventLoop) -> Result<(Rc<Frameless>, Canvas), WindowError> {
        let (width, height) = self.viewer.size();
        let wanted = Frameless::default_attributes()
            .with_title(self.title)
            .with_inner_size(PhysicalSize::new(width, height));
        let window = Rc::new(events.create_window(wanted).map_err(failed)?);
        let canvas = Surface::new(&self.context, window.clone()).map_err(failed)?;
        Ok((window, canvas))
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: WindowError) {
        self.failure.get_or_insert(error);
        events.exit();
    }

    fn act(&mut self, action: Action) {
        self.viewer.act(action);
        self.studio.ask(self.exhibit.clone(), self.viewer.look());
    }

    fn present(&mut self) -> Result<(), WindowError> {
        let (Some((_, canvas)), Some(frame)) = (&mut self.pane, &self.frame) else {
            return Ok(());
        };
        let (width, height) = self.viewer.size();
        let sides = NonZeroU32::new(width).zip(NonZeroU32::new(height));
        let Some((columns, rows)) = sides else {
            return Ok(());
        };
        canvas.resize(columns, rows).map_err(failed)?;
        let mut pixels = canvas.buffer_mut().map_err(failed)?;
        frame.fill(&mut pixels, width, height);
        pixels.present().map_err(failed)
    }

    fn moved(&mut self, at: DVec2) {
        let by = at - self.pointer.at;
        self.pointer.at = at;
        match self.pointer.down {
            Some((MouseButton::Left, _)) => self.act(Action::Orbit(by)),
            Some((MouseButton::Right, _)) => self.act(Action::Turn(by)),
            _ => {}
        }
    }

    fn pressed(&mut self, button: MouseButton, state: ElementState) -> Result<(), WindowError> {
        let at = self.pointer.at;
        match state {
            ElementState::Pressed => self.pointer.down = Some((button, at)),
            ElementState::Released => {
                let down = self.pointer.down.take();
                let clicked = |(first, from): (MouseButton, DVec2)| {
                    first == MouseButton::Left && from.distance(at) <= CLICK
                };
                if down.is_some_and(clicked) {
                    self.read(at)?;
                }
            }
        }
        Ok(())
    }

    /// Says how much light there is in the middle of a pixel.
    fn read(&mut self, at: DVec2) -> Result<(), WindowError> {
        let pixel = at.floor() + 0.5;
        let reading = Reading::take(&self.exhibit, &self.viewer.look(), pixel)?;
        let title = match &reading {
            Some(reading) => format!("{}: {reading}", self.title),
            None => self.title.to_owned(),
        };
        if let Some((window, _)) = &self.pane {
            window.set_title(&title);
        }
        if let Some(reading) = &reading {
            (self.hooks.read)(reading);
        }
        Ok(())
    }

    fn on(&mut self, events: &ActiveEventLoop, event: WindowEvent) -> Result<(), WindowError> {
        match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => events.exit(),
            WindowEvent::RedrawRequested => self.present()?,
            WindowEvent::Resized(size) if size.width > 0 && size.height > 0 => {
                self.act(Action::Resize(size.width, size.height));
            }
            WindowEvent::ModifiersChanged(now) => self.pointer.modifiers = now.state(),
            WindowEvent::CursorMoved { position, .. } => {
                self.moved(DVec2::new(position.x, position.y));
            }
            WindowEvent::MouseInput { button, state, .. } => self.pressed(button, state)?,
            WindowEvent::MouseWheel { delta, .. } => self.act(Action::Zoom(match delta {
                MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
                MouseScrollDelta::PixelDelta(pixels) => pixels.y / NOTCH,
            })),
            WindowEvent::KeyboardInput { event, .. } if event.state.is_pressed() => {
                match wish(&event.logical_key, self.pointer.modifiers.shift_key()) {
                    Some(Wish::Quit) => events.exit(),
                    Some(Wish::Act(action)) => self.act(action),
                    None => {}
                }
            }
            _ => {}
        }
        Ok(())
    }
}

impl ApplicationHandler<Notice> for Desk<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.pane.is_none() {
            match self.open(events) {
                Ok(pane) => self.pane = Some(pane),
                Err(error) => self.fail(events, error),
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if let Err(error) = self.on(events, event) {
            self.fail(events, error);
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, notice: Notice) {
        match notice {
            Notice::Show(exhibit) => {
                self.exhibit = exhibit;
                self.studio.ask(self.exhibit.clone(), self.viewer.look());
            }
            Notice::Drawn(Ok(frame)) => {
                self.viewer.seen(frame.exposure);
                self.frame = Some(frame);
                if let Some((window, _)) = &self.pane {
                    window.request_redraw();
                }
            }
            Notice::Drawn(Err(error)) => self.fail(events, error.into()),
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        if (self.hooks.is_over)() {
            events.exit();
        }
        events.set_control_flow(ControlFlow::WaitUntil(Instant::now() + POLL));
    }
}
