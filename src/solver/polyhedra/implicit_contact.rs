//! A contact between features whose springs and dashpot are taken implicitly.
//!
//! Not here: what they are ([`super::contact_group`]), what is made of them ([`super::couplings`],
//! [`super::gaps`]).

use crate::lanes::Row;

/// A contact's springs and its dashpot.
#[derive(Clone, Copy, Debug, Default)]
pub struct ImplicitContact {
    /// Unit normal; the dashpot, none where the contact has let go [N s/m].
    pub normal: Row,
    /// The arm across the normal [m]; the normal spring, none where the contact has let go [N/m].
    pub moment: Row,
    /// The arm [m]; how stiff the contact is against a change of its slip within a step [N/m].
    pub arm: Row,
    /// Of a gap that closes within the step: its spring [N/m], none where it is none, and its
    /// overlap, which is negative [m].
    pub closing: Row,
}

impl ImplicitContact {
    /// The spring of a gap that closes within the step, none where it is none [N/m].
    pub fn closing_spring(&self) -> f64 {
        self.closing[0]
    }
}
