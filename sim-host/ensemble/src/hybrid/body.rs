//! The body of the block in every lane.

use sprag_shared::equation::FullBlock;
use sprag_shared::equation::any_body::AnyBody;
use sprag_shared::equation::body::{Body, FullBody, SlenderBody};
use sprag_shared::equation::lever::TyingPoint;

use super::Kind;
use crate::{Number, number};

/// Body of the block in every lane.
pub(crate) trait LaneBody: Body<Number> {
    /// A harmless one, whose motions idle lanes go through.
    fn harmless() -> Self;

    /// The body of another block in `lane`, which is of this type.
    fn renew(&mut self, lane: usize, body: &AnyBody<f64>);

    /// The same, with what all lanes have in common.
    fn known(&self, kind: Kind) -> Self;
}

impl LaneBody for FullBody<Number> {
    fn harmless() -> Self {
        let (zero, one) = (number(0.0), number(1.0));
        let block = FullBlock { frequency_squared: one, slenderness: one };
        FullBody { block, lever: TyingPoint { along: one, across: zero }, consistent: true, vertical: true }
    }

    fn renew(&mut self, lane: usize, body: &AnyBody<f64>) {
        let AnyBody::Full(FullBody { block, lever, .. }) = body else { return };
        self.block.frequency_squared.0[lane] = block.frequency_squared;
        self.block.slenderness.0[lane] = block.slenderness;
        (self.lever.along.0[lane], self.lever.across.0[lane]) = (lever.along, lever.across);
    }

    #[inline(always)]
    fn known(&self, kind: Kind) -> Self {
        FullBody { consistent: kind.consistent, vertical: kind.vertical, ..*self }
    }
}

impl LaneBody for SlenderBody<Number> {
    fn harmless() -> Self {
        let one = number(1.0);
        SlenderBody { frequency_squared: one, slenderness: one, lever: one, vertical: true }
    }

    fn renew(&mut self, lane: usize, body: &AnyBody<f64>) {
        let AnyBody::Slender(body) = body else { return };
        self.frequency_squared.0[lane] = body.frequency_squared;
        self.slenderness.0[lane] = body.slenderness;
        self.lever.0[lane] = body.lever;
    }

    #[inline(always)]
    fn known(&self, kind: Kind) -> Self {
        SlenderBody { vertical: kind.vertical, ..*self }
    }
}
