//! Latitudes of satellite receivers, beside a parser that others wrote.

use nmea::ParseResult;
use proptest::prelude::*;
use protocol::position::latitude;

/// A sentence with this content.
fn sentence(content: &str) -> String {
    format!("${content}*{:02X}", content.bytes().fold(0, |sum, byte| sum ^ byte))
}

/// The latitude of a sentence with this content, °.
fn degrees(content: &str) -> Option<f64> {
    latitude(&sentence(content)).map(|latitude| latitude.rad().to_degrees())
}

/// GGA with these fields of latitude, hemisphere and quality.
fn gga(latitude: &str, hemisphere: &str, quality: &str) -> String {
    format!(
        "GPGGA,092750.000,{latitude},{hemisphere},00630.3372,W,{quality},8,1.03,61.7,M,55.2,M,,"
    )
}

/// RMC with these fields of status, latitude and hemisphere, and what comes behind the magnetic variation.
fn rmc(status: &str, latitude: &str, hemisphere: &str, rest: &str) -> String {
    format!(
        "GNRMC,225446.33,{status},{latitude},{hemisphere},12311.12,W,000.5,054.7,191194,020.3,E{rest}"
    )
}

#[test]
fn positions_that_were_measured_have_a_latitude() {
    let expected = 53.0 + 21.6802 / 60.0;
    for quality in ["1", "2", "3", "4", "5"] {
        let found = degrees(&gga("5321.6802", "N", quality)).expect("it has a latitude");
        assert!((found - expected).abs() < 1e-12, "{found}°");
    }
    for rest in ["", ",A", ",D", ",R,V", ",A,V"] {
        let found = degrees(&rmc("A", "5321.6802", "S", rest)).expect("it has a latitude");
        assert!((found + expected).abs() < 1e-12, "{found}°");
    }
}

#[test]
fn positions_that_were_not_measured_have_none() {
    for quality in ["0", "6", "7", "8", "", "10"] {
        assert_eq!(degrees(&gga("5321.6802", "N", quality)), None, "quality {quality}");
    }
    for (status, rest) in
        [("V", ""), ("V", ",A"), ("A", ",N"), ("A", ",S"), ("A", ",M"), ("A", ",E"), ("", ",A")]
    {
        assert_eq!(degrees(&rmc(status, "5321.6802", "N", rest)), None, "{status}{rest}");
    }
}

#[test]
fn a_latitude_that_is_malformed_is_none() {
    for field in [
        "",
        "0",
        "53",
        "5360.0",
        "9100.0",
        "9000.1",
        "532.16",
        "53216.802",
        "-5321.68",
        "5321,68",
        "5321.6x",
    ] {
        assert_eq!(degrees(&gga(field, "N", "1")), None, "{field}");
    }
    for hemisphere in ["", "n", "W", "NN"] {
        assert_eq!(degrees(&gga("5321.6802", hemisphere, "1")), None, "{hemisphere}");
    }
    assert_eq!(
        latitude("$GPGGA,092750.000,5321.6802,N,00630.3372,W,1,8,1.03,61.7,M,55.2,M,,*75"),
        None
    );
    assert_eq!(
        latitude("GPGGA,092750.000,5321.6802,N,00630.3372,W,1,8,1.03,61.7,M,55.2,M,,*76"),
        None
    );
    for content in [
        "GPGLL,5321.6802,N,00630.3372,W,092750.000,A",
        "PGGA,1",
        "GPGGA",
        "GPGGA,,,,,,,,,,,,,,",
        "\u{e9}GGA,",
    ] {
        assert_eq!(degrees(content), None, "{content}");
    }
}

proptest! {
    #[test]
    fn a_latitude_is_that_which_others_read(degrees in 0..90_u32, minutes in 0..600_000_u32, south: bool) {
        let field = format!("{degrees:02}{:02}.{:04}", minutes / 10_000, minutes % 10_000);
        let content = gga(&field, if south { "S" } else { "N" }, "4");
        let ParseResult::GGA(read) = nmea::parse_str(&sentence(&content)).expect("it is a sentence") else {
            panic!("it is another sentence")
        };
        let found = self::degrees(&content).expect("it has a latitude");
        prop_assert!((found - read.latitude.expect("it has one")).abs() < 1e-9, "{}°", found);
    }

    #[test]
    fn no_line_is_too_odd(line in "(\\$(GP|GN)?(GGA|RMC))?[ -~]{0,90}") {
        let _ = latitude(&line);
    }
}
