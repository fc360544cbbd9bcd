//! Generalised autocovariances.
