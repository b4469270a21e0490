//! Block pattern of the normal equations and the elimination order of their nodes.
//!
//! Both depend on the graph alone, not on the poses: they are computed once and reused in every iteration and
//! every solve until the graph grows.

use crate::problem::Problem;

/// Position of the off-diagonal block of a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FactorSlot {
    /// Index into the off-diagonal blocks, or [`FactorSlot::NONE`] if an end is fixed.
    pub slot: u32,
    /// Whether pose `from` is eliminated after pose `to`: the block is stored transposed.
    pub transposed: bool,
}

impl FactorSlot {
    /// The slot of a factor without an off-diagonal block.
    pub const NONE: u32 = u32::MAX;
}

/// The block pattern of the normal equations in elimination order, lower triangle by columns.
///
/// A fixed node keeps its position with an identity block and no off-diagonal blocks, which is equivalent to
/// clearing its rows and columns and putting ones on the diagonal.
#[derive(Clone, Debug, Default)]
pub struct Structure {
    /// Elimination position of every node.
    pub position_of: Vec<u32>,
    /// Node at every elimination position.
    pub node_at: Vec<u32>,
    /// Start of every column among the off-diagonal blocks, and the end of the last.
    pub column_start: Vec<u32>,
    /// Row of every off-diagonal block, below the diagonal, ascending in each column.
    pub row: Vec<u32>,
    /// Position of every factor's block.
    pub factor_slots: Vec<FactorSlot>,
    /// Fixed flags and ends of the factors from which the structure was made.
    fixed: Vec<bool>,
    ends: Vec<(u32, u32)>,
}

impl Structure {
    /// Computes pattern and slots for `problem`, with node `node_at[k]` eliminated at position `k`.
    ///
    /// # Panics
    /// If `node_at` is not a permutation of the nodes.
    #[must_use]
    pub fn new(problem: &Problem, node_at: Vec<u32>) -> Self {
        let nodes = problem.node_count();
        assert_eq!(node_at.len(), nodes, "an elimination order has every node");
        let mut position_of = vec![u32::MAX; nodes];
        for (position, &node) in (0_u32..).zip(&node_at) {
            assert_eq!(
                position_of[node as usize],
                u32::MAX,
                "node {node} is eliminated twice"
            );
            position_of[node as usize] = position;
        }
        let (fixed, ends) = signature(problem);
        let mut structure = Self {
            position_of,
            node_at,
            column_start: Vec::new(),
            row: Vec::new(),
            factor_slots: vec![
                FactorSlot {
                    slot: FactorSlot::NONE,
                    transposed: false
                };
                ends.len()
            ],
            fixed,
            ends,
        };
        structure.place_factors();
        structure
    }

    /// Whether `problem` still has the graph of this structure.
    #[must_use]
    pub fn fits(&self, problem: &Problem) -> bool {
        self.fixed == problem.fixed()
            && self.ends.len() == problem.factors().len()
            && self
                .ends
                .iter()
                .zip(problem.factors())
                .all(|(&(from, to), factor)| {
                    from as usize == factor.from && to as usize == factor.to
                })
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.node_at.len()
    }

    /// The rows below the diagonal of a column.
    #[must_use]
    pub fn rows_of(&self, column: usize) -> &[u32] {
        &self.row[self.slots_of(column)]
    }

    /// The slots of a column.
    #[must_use]
    pub fn slots_of(&self, column: usize) -> core::ops::Range<usize> {
        self.column_start[column] as usize..self.column_start[column + 1] as usize
    }

    /// Sorts the factors by (column, row) with two counting passes, and numbers the distinct pairs.
    fn place_factors(&mut self) {
        let nodes = self.node_count();
        let pairs: Vec<(u32, u32, u32)> = self.free_pairs();
        let by_row = counting_sort(&pairs, nodes, |pair| pair.1);
        let by_column = counting_sort(&by_row, nodes, |pair| pair.0);
        self.column_start = vec![0; nodes + 1];
        let mut last = None;
        for (column, row, factor) in by_column {
            if last != Some((column, row)) {
                last = Some((column, row));
                self.row.push(row);
                self.column_start[column as usize + 1] += 1;
            }
            self.factor_slots[factor as usize] = FactorSlot {
                slot: self.row.len() as u32 - 1,
                transposed: self.position_of[self.ends[factor as usize].0 as usize] == row,
            };
        }
        for column in 0..nodes {
            self.column_start[column + 1] += self.column_start[column];
        }
    }

    /// `(column, row, factor)` in elimination positions for the factors between free nodes.
    fn free_pairs(&self) -> Vec<(u32, u32, u32)> {
        (0_u32..)
            .zip(&self.ends)
            .filter(|(_, (from, to))| !self.fixed[*from as usize] && !self.fixed[*to as usize])
            .map(|(factor, &(from, to))| {
                let a = self.position_of[from as usize];
                let b = self.position_of[to as usize];
                (a.min(b), a.max(b), factor)
            })
            .collect()
    }
}

/// The parts of a problem that determine its structure.
fn signature(problem: &Problem) -> (Vec<bool>, Vec<(u32, u32)>) {
    let ends = problem
        .factors()
        .iter()
        .map(|factor| (factor.from as u32, factor.to as u32))
        .collect();
    (problem.fixed().to_vec(), ends)
}

/// A stable sort by a key below `keys`, in linear time.
fn counting_sort<T: Copy + Default>(items: &[T], keys: usize, key: impl Fn(&T) -> u32) -> Vec<T> {
    let mut start = vec![0_u32; keys + 1];
    for item in items {
        start[key(item) as usize + 1] += 1;
    }
    for k in 0..keys {
        start[k + 1] += start[k];
    }
    let mut sorted = vec![T::default(); items.len()];
    for item in items {
        let place = &mut start[key(item) as usize];
        sorted[*place as usize] = *item;
        *place += 1;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::factor::Between;
    use nalgebra::Matrix3;
    use pr_geom::SE2;

    fn ring(nodes: usize) -> Problem {
        let mut problem = Problem::new();
        problem.add_fixed_pose(SE2::identity());
        for _ in 1..nodes {
            problem.add_pose(SE2::identity());
        }
        for from in 0..nodes {
            problem.add_factor(Between {
                from,
                to: (from + 1) % nodes,
                measurement: SE2::identity(),
                information: Matrix3::identity(),
            });
        }
        problem
    }

    #[test]
    fn factors_at_a_fixed_node_have_no_block_beside_the_diagonal() {
        let structure = Structure::new(&ring(5), vec![0, 1, 2, 3, 4]);
        assert_eq!(structure.row, [2, 3, 4]);
        assert_eq!(structure.rows_of(0), [] as [u32; 0]);
        assert_eq!(structure.factor_slots[0].slot, FactorSlot::NONE);
        assert_eq!(structure.factor_slots[4].slot, FactorSlot::NONE);
    }

    #[test]
    fn two_factors_between_the_same_nodes_share_a_block() {
        let mut problem = ring(4);
        let mut back = problem.factors()[1];
        (back.from, back.to) = (back.to, back.from);
        problem.add_factor(back);
        let structure = Structure::new(&problem, vec![3, 2, 1, 0]);
        let [there, back] = [structure.factor_slots[1], structure.factor_slots[4]];
        assert_eq!(there.slot, back.slot);
        assert_ne!(there.transposed, back.transposed);
        // Factor 1 goes from node 1 (position 2) to node 2 (position 1): its rows belong to `from`.
        assert!(there.transposed);
    }

    #[test]
    fn a_grown_graph_does_not_fit() {
        let mut problem = ring(4);
        let structure = Structure::new(&problem, vec![0, 1, 2, 3]);
        assert!(structure.fits(&problem));
        problem.add_pose(SE2::identity());
        assert!(!structure.fits(&problem));
    }
}
