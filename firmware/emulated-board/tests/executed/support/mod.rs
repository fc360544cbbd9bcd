//! What the tests share: images that are built once, executions that are made once, and boards that are stepped.

#[path = "../../support/angles.rs"]
pub mod angles;
#[path = "../../support/board.rs"]
pub mod board;
pub mod executed;
#[path = "../../support/figure.rs"]
pub mod figure;
#[path = "../../support/images.rs"]
pub mod images;
pub mod line;
#[path = "../../../../../host-tests/tests/support/sentences.rs"]
pub mod sentences;
pub mod worlds;
