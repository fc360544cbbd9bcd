//! Where up points later and elsewhere, against the ellipsoid computed another way.

use orientation::alignment::stops::place::{Place, up};
use orientation::earth::Latitude;
use orientation::math::rotation::Vector;

use super::assert_near;

/// Of a place: latitude, °; s and m north and m east later; radii along and across the meridian, m; up, the
/// Earth's axis and the later north in the first north, east, down.
///
/// python 3, mpmath 1.3.0 from a = 6378137, 1/f = 298.257223563, b = a (1 − f):
/// M = (ab)²/((a cos φ)² + (b sin φ)²)^1.5, N = a²/√((a cos φ)² + (b sin φ)²), later latitude φ + n/M,
/// longitude e/(N cos φ) + 7.292115e-5 t; up = F (cos φ' cos λ', cos φ' sin λ', sin φ') with the rows of F
/// the first north, east, down in Earth-centred axes.
struct Case {
    latitude: f64,
    seconds: f64,
    displacement: [f64; 2],
    radii: [f64; 2],
    up: Vector,
    axis: Vector,
    north: Vector,
}

const CASES: [Case; 4] = [
    Case {
        latitude: 52.0,
        seconds: 960.0,
        displacement: [-2134.0, 2737.8],
        radii: [6_375_149.741_275_792, 6_391_435.268_211_297],
        up: [0.000_877_782_672_710_321_7, 0.043_509_685_811_520_12, -0.999_052_619_604_274],
        axis: [0.615_661_475_325_658_3, 0.0, -0.788_010_753_606_722],
        north: [0.998_449_059_616_060_9, -0.055_651_450_423_528_2, -0.001_546_420_887_600_661],
    },
    Case {
        latitude: -33.5,
        seconds: 1800.0,
        displacement: [5200.0, -4100.0],
        radii: [6_354_869.008_118_419, 6_384_650.554_919_741],
        up: [-0.003_096_676_184_608_134, 0.108_562_277_975_323_5, -0.994_084_826_560_297_3],
        axis: [0.833_885_822_067_168_2, 0.0, 0.551_936_985_312_058_1],
        north: [0.997_413_023_199_194_4, 0.071_728_122_935_710_72, 0.004_726_259_912_740_835],
    },
    Case {
        latitude: 0.0,
        seconds: 3600.0,
        displacement: [0.0, 1000.0],
        radii: [6_335_439.327_292_819_5, 6_378_137.0],
        up: [0.0, 0.259_662_718_963_480_6, -0.965_699_369_566_167_1],
        axis: [1.0, 0.0, 0.0],
        north: [1.0, 0.0, 0.0],
    },
    Case {
        latitude: 84.0,
        seconds: 600.0,
        displacement: [-800.0, 150.0],
        radii: [6_398_886.819_670_550_5, 6_399_358.015_054_923],
        up: [-2.439_461_230_764_912_4e-5, 0.004_600_825_907_086_068, -0.999_989_415_846_925_6],
        axis: [0.104_528_463_267_653_46, 0.0, -0.994_521_895_368_273_3],
        north: [0.999_043_739_013_966_6, -0.043_721_352_610_741_86, -0.000_225_528_003_498_898_83],
    },
];

#[test]
fn up_north_and_radii_are_those_of_the_ellipsoid() {
    for case in CASES {
        let latitude = Latitude::from_degrees(case.latitude).expect("a latitude");
        let place = Place::new(latitude);
        let navigation = place.navigation(case.seconds, case.displacement);
        for axis in 0..3 {
            assert_near(up(&navigation)[axis], case.up[axis], 1e-14);
            assert_near(place.axis()[axis], case.axis[axis], 1e-14);
            assert_near(navigation[axis][0], case.north[axis], 1e-14);
        }
        for (radius, expected) in latitude.radii().into_iter().zip(case.radii) {
            assert_near(radius.0, expected, 1e-3);
        }
        for (turned, radius) in place.per_metre().into_iter().zip(case.radii) {
            assert_near(turned * radius, 1.0, 1e-9);
        }
        // North turns by tan φ of the way east over the radius.
        let expected = case.latitude.to_radians().tan() / case.radii[1];
        assert_near(place.convergence(), expected, 1e-9 * expected.abs().max(1e-12));
    }
}

#[test]
fn a_place_moved_north_sees_the_earths_axis_higher() {
    let latitude = Latitude::from_degrees(-20.0).expect("a latitude");
    let axis = Place::moved(latitude, 0.01).axis();
    let expected = (-20f64).to_radians() + 0.01;
    assert_near(axis[0], expected.cos(), 1e-15);
    assert_near(-axis[2], expected.sin(), 1e-15);
}
