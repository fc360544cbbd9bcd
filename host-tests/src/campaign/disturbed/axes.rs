//! How a unit may be built in wrongly: axes that are flipped together, or turned by 90°.

use crate::campaign::chance::Chance;

/// What the columns show of the true axes, row by row.
pub(super) type Axes = [[f64; 3]; 3];

/// Axes that stand as they should: each column shows its own axis.
pub(super) const UPRIGHT: Axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Turned about the vertical by 180°, 90° and −90°: what a level unit does not show.
pub(super) const TURNED: [Axes; 3] = [
    [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
];

/// One of the ways in which level axes are turned.
pub(super) fn turned(chance: &mut Chance) -> Axes {
    chance.one_of(&TURNED)
}

/// What the columns show.
pub(super) fn shown(axes: &Axes, values: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|row: usize| (0..3).map(|column| axes[row][column] * values[column]).sum())
}
