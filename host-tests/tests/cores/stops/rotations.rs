//! Rotations against scipy's, and levelling against its definition.

use orientation::alignment::stops::inclination::pitch_and_roll;
use orientation::math::quaternion::Attitude;
use orientation::math::rotation::{
    Matrix, Vector, about_down, by, levelled, product, small, transposed, turned,
};
use proptest::prelude::*;

use super::assert_near;

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

#[track_caller]
fn assert_matrix(value: &Matrix, expected: &Matrix, tolerance: f64) {
    for (value, expected) in value.iter().flatten().zip(expected.iter().flatten()) {
        assert_near(*value, *expected, tolerance);
    }
}

#[test]
fn rotations_are_those_of_scipy() {
    // scipy 1.17.1, R = scipy.spatial.transform.Rotation: R.from_rotvec([0.3, -1.1, 0.7]).as_matrix().
    let first = [
        [0.269_463_503_028_091_63, -0.650_890_186_163_428_1, -0.709_740_365_268_855],
        [0.367_270_134_397_863_6, 0.750_758_136_327_231_3, -0.549_067_271_942_006_7],
        [0.890_225_852_756_032_3, -0.112_712_848_844_310_26, 0.441_354_443_492_07],
    ];
    // (R.from_rotvec([0.3, -1.1, 0.7]) * R.from_rotvec([-0.004, 0.002, 0.013])).as_matrix().
    let both = [
        [0.262_419_381_414_991_77, -0.651_504_327_246_402_7, -0.711_813_304_060_120_3],
        [0.378_107_286_863_250_9, 0.748_101_924_028_332_9, -0.545_324_115_445_134],
        [0.887_789_923_280_662_4, -0.126_038_180_105_548_82, 0.442_654_977_693_685_17],
    ];
    assert_matrix(&by(&[0.3, -1.1, 0.7]), &first, 1e-15);
    assert_matrix(&product(&first, &by(&[-0.004, 0.002, 0.013])), &both, 1e-15);
    let mut attitude = Attitude::default();
    attitude.turn(&[0.3, -1.1, 0.7]);
    assert_matrix(&attitude.matrix(), &first, 2e-7);
    attitude.turn(&[-0.004, 0.002, 0.013]);
    assert_matrix(&attitude.matrix(), &both, 2e-7);
}

#[test]
fn levelling_undoes_pitch_and_roll() {
    // R.from_euler('ZYX', [0, 0.21, -0.37]).as_matrix(): pitch 0.21, roll −0.37; up is minus its last row.
    let expected = [
        [0.978_030_914_724_148_2, -0.075_382_316_730_22, 0.194_352_865_088_813_8],
        [0.0, 0.932_327_345_606_034_4, 0.361_615_431_964_962],
        [-0.208_459_899_846_099_56, -0.353_671_071_703_059_7, 0.911_844_966_645_406_9],
    ];
    let up = expected[2].map(|part: f64| -part);
    assert_matrix(&levelled(&up), &expected, 1e-15);
    let [pitch, roll] = pitch_and_roll(&up);
    assert_near(pitch.0, 0.21, 1e-15);
    assert_near(roll.0, -0.37, 1e-15);
}

fn vector(largest: f64) -> impl Strategy<Value = Vector> {
    prop::array::uniform3(-largest..largest)
}

proptest! {
    #[test]
    fn the_series_for_small_angles_meets_the_functions(rotation in vector(0.03)) {
        let angle = rotation.iter().map(|part| part * part).sum::<f64>().sqrt();
        prop_assume!(angle > 1e-6);
        // Rodrigues.
        let [x, y, z] = rotation.map(|part| part / angle);
        let (sine, versine) = (angle.sin(), 2.0 * (0.5 * angle).sin().powi(2));
        let expected = [
            [1.0 - versine * (y * y + z * z), versine * x * y - sine * z, versine * x * z + sine * y],
            [versine * x * y + sine * z, 1.0 - versine * (x * x + z * z), versine * y * z - sine * x],
            [versine * x * z - sine * y, versine * y * z + sine * x, 1.0 - versine * (x * x + y * y)],
        ];
        assert_matrix(&by(&rotation), &expected, 3e-16);
    }

    #[test]
    fn there_and_back_is_nowhere(rotation in vector(3.0), further in vector(3.0)) {
        let back = rotation.map(|part| -part);
        assert_matrix(&product(&by(&rotation), &by(&back)), &IDENTITY, 4e-15);
        let mut chain = Attitude::default();
        chain.turn(&rotation.map(|part| part as f32));
        chain.turn(&further.map(|part| part as f32));
        assert_matrix(&chain.matrix(), &product(&by(&rotation), &by(&further)), 2e-6);
    }

    #[test]
    fn a_small_rotation_gives_its_vector_back(rotation in vector(1e-4)) {
        for (part, expected) in small(&by(&rotation)).into_iter().zip(rotation) {
            assert_near(part, expected, 1e-12);
        }
    }

    #[test]
    fn levelled_axes_are_level_and_point_where_the_body_does(rotation in vector(1.0), azimuth in 0.0..6.0f64) {
        let body = by(&rotation);
        let up = body[2].map(|part| -part);
        let level = levelled(&up);
        // Right handed, z down, x over the body's.
        assert_matrix(&product(&level, &transposed(&level)), &IDENTITY, 1e-14);
        for (part, expected) in turned(&level, &up).into_iter().zip([0.0, 0.0, -1.0]) {
            assert_near(part, expected, 1e-14);
        }
        assert_near(level[1][0], 0.0, 1e-14);
        prop_assert!(level[0][0] > 0.0);
        // About down by the azimuth: north, east, down of x is (cos, sin).
        let north_east = product(&about_down(azimuth), &level);
        prop_assert!((north_east[1][0].atan2(north_east[0][0]).rem_euclid(std::f64::consts::TAU) - azimuth).abs() < 1e-12);
    }
}
