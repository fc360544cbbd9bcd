//! Covariance of Allan variances.
