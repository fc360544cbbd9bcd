//! What the tests share: images that are built once, executions that are made once, boards that are stepped, and defects
//! that are known.

#[path = "../../support/board.rs"]
pub mod board;
#[path = "../../support/defect.rs"]
pub mod defect;
pub mod executed;
#[path = "../../support/figure.rs"]
pub mod figure;
#[path = "../../support/images.rs"]
pub mod images;
pub mod worlds;
