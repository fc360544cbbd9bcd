//! The etalon table and the search of it.
