//! Initial guesses of the attempts of a session.

use pr_geom::SE2;

use super::attempt::TriedStart;
use super::{Round, SolveSession, Start};
use crate::error::OptimizeError;
use crate::init::{chordal, spanning_tree};
use crate::report::StopReason;

impl SolveSession<'_> {
    /// Takes the better of the given poses and the spanning tree.
    pub(super) fn start_cheaply(&mut self) {
        self.steps.clear();
        self.optimizer.restart();
        let tree = spanning_tree(self.problem);
        let given = self.optimizer.cost_at(self.problem, self.problem.poses());
        if self.round == Round::Guess {
            self.given_cost = Some(given);
        }
        let of_tree = self.optimizer.cost_at(self.problem, &tree);
        let takes_tree = of_tree.is_finite() && (of_tree < given || !given.is_finite());
        let (start, other, cost) = if takes_tree {
            self.problem.poses_mut().copy_from_slice(&tree);
            (Start::SpanningTree, Start::Given, given)
        } else {
            (Start::Given, Start::SpanningTree, of_tree)
        };
        self.start = start;
        self.pass_over(other, cost);
    }

    /// Records a guess of this cost that is not followed.
    fn pass_over(&mut self, start: Start, cost: f64) {
        self.tried.push(TriedStart {
            start,
            method: self.optimizer.settings.method,
            kernel: self.optimizer.settings.kernel,
            iterations: 0,
            cost_initial: cost,
            cost,
            stop: None,
        });
    }

    pub(super) fn start_from(&mut self, start: Start) -> Result<(), OptimizeError> {
        match start {
            Start::Auto | Start::Given => {}
            Start::SpanningTree => {
                let poses = spanning_tree(self.problem);
                self.move_to(&poses)?;
            }
            Start::Chordal => {
                let linear = self.optimizer.linear_for(self.problem);
                let poses = chordal(self.problem, linear)?;
                self.move_to(&poses)?;
            }
            Start::LeastSquares => self.problem.poses_mut().copy_from_slice(&self.origin),
        }
        self.start = start;
        self.steps.clear();
        self.optimizer.restart();
        Ok(())
    }

    /// Moves to a guess if its cost is finite.
    fn move_to(&mut self, guess: &[SE2]) -> Result<(), OptimizeError> {
        if !self.optimizer.cost_at(self.problem, guess).is_finite() {
            return Err(OptimizeError::NotFinite);
        }
        self.problem.poses_mut().copy_from_slice(guess);
        Ok(())
    }

    /// Continues the abandoned first attempt if the chordal relaxation costs more than its result.
    pub(super) fn resume_first_if_chordal_costs_more(&mut self) {
        let cost = self.optimizer.cost_at(self.problem, self.problem.poses());
        let first = self.ended.last().expect("the first attempt has ended");
        let was_given_up = matches!(first.report.stop, StopReason::LowGainRatio { .. });
        if !was_given_up || cost < first.report.cost {
            return;
        }
        let first = self.ended.pop().expect("the first attempt has ended");
        self.tried.pop();
        self.pass_over(Start::Chordal, cost);
        self.problem.poses_mut().copy_from_slice(&first.poses);
        self.start = first.start;
        self.steps = first.report.steps;
    }
}
