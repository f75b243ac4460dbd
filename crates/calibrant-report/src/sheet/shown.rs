//! Where a part of a sheet is shown.

/// The printers that show a part of a sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shown {
    /// On pages and on terminals.
    #[default]
    Everywhere,
    /// On pages only: details, explanations, long tables.
    OnPage,
    /// On terminals only.
    OnTerminal,
}

impl Shown {
    /// Does a page show it?
    pub(super) fn on_page(self) -> bool {
        self != Self::OnTerminal
    }

    /// Does a terminal show it?
    pub(super) fn on_terminal(self) -> bool {
        self != Self::OnPage
    }
}
