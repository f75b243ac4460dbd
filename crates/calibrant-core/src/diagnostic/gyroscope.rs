//! Checks of the gyroscope beside the accelerometer: clocks, axes, rotations.

use super::check::checks;
use super::late_times::{late, repair};
use super::rotation_reason::RotationReason;

checks! {
    /// The gyroscope shows movements earlier or later than the accelerometer.
    TimeOffset "time-offset" Warning {
        /// By how much the gyroscope is late, s.
        offset_s: f64,
        /// Its standard deviation, s.
        offset_sd_s: f64,
    }
    decided "The offset is significant, and exceeds both 5 ms and 1.5 sample intervals."
    remedy "Correct the gyroscope's times by the offset."
    says format!(
        "the gyroscope shows movements {} than the accelerometer (± {:.1} ms). Either one sensor has a latency, or the \
         clocks differ. The offset shortens holds and rotations. To correct it, {}.",
        late(*offset_s, 1),
        1e3 * offset_sd_s,
        repair(*offset_s, 0.0, 4)
    );

    /// The clocks of the two sensors run at different rates.
    ClockSkew "clock-skew" Warning {
        /// By how much the gyroscope is late at its first sample, s.
        first_offset_s: f64,
        /// By how much the gyroscope is late at its last sample, s.
        last_offset_s: f64,
        /// How much later it becomes with each second.
        skew: f64,
        /// Its standard deviation.
        skew_sd: f64,
    }
    decided "The skew is significant, and large enough to affect the result."
    remedy "Correct the gyroscope's times by offset and skew."
    says format!(
        "the clocks of the two sensors run at different rates, by {:+.4} ± {:.4} %. The gyroscope shows movements {} \
         than the accelerometer at the beginning, and {} at the end. If the accelerometer's clock is right, the \
         gyroscope's gains are too {} by this percentage. To correct it, {}.",
        100.0 * skew,
        100.0 * skew_sd,
        late(*first_offset_s, 1),
        late(*last_offset_s, 1),
        if *skew > 0.0 { "large" } else { "small" },
        repair(*first_offset_s, *skew, 3)
    );

    /// The gyroscope's axes are in another order than the accelerometer's.
    AxesInOtherOrder "axes-in-other-order" Error {
        /// The gyroscope's axis along each of the accelerometer's.
        order: [String; 3],
        /// Do turns of known angle show it?
        by_turns: bool,
    }
    decided "The rotations or turns fit only with that order."
    remedy "Correct the columns, or keep the order in mind."
    says {
        let [x, y, z] = order;
        let housing = match by_turns {
            true => " If both sensors share a housing, correct the order of the turns or of the gyroscope's columns.",
            false => "",
        };
        format!(
            "the gyroscope's axes are in another order than the accelerometer's: along x, y and z of the accelerometer \
             lie {x}, {y} and {z} of the gyroscope.{housing}"
        )
    };

    /// The gyroscope is mounted with a rotation against the accelerometer.
    GyroscopeTurned "gyroscope-turned" Warning {
        /// Angle of the rotation, rad.
        angle_rad: f64,
        /// Axis of the rotation, along x.
        about_x: f64,
        /// Axis of the rotation, along y.
        about_y: f64,
        /// Axis of the rotation, along z.
        about_z: f64,
        /// Do its axes point the opposite way?
        is_mirrored: bool,
    }
    decided "The rotations fit with that mounting, and not with the axes as recorded."
    remedy "Correct the columns, or keep the mounting in mind."
    says format!(
        "the gyroscope is mounted with a rotation of {:.0}° against the accelerometer, about the axis ({about_x:.2}, \
         {about_y:.2}, {about_z:.2}){}",
        angle_rad.to_degrees(),
        if *is_mirrored { ". Its axes point the opposite way" } else { "" }
    );

    /// The rotations miss gravity by far more than the gyroscope's noise and knocks explain.
    RotationsScatter "rotations-scatter" Warning {
        /// Standard deviation of the rotation errors beyond noise and knocks, rad.
        excess_sd_rad: f64,
        /// The largest rate of a rotation, rad/s.
        peak_radps: f64,
    }
    decided "The standard deviation beyond noise and knocks is more than 0.6°, more than 1 % of the angle of the rotations, and more than that of the noise."
    remedy "Turn the sensor more slowly, and look at the rotations in the report: errors that grow with the rate are those of a range."
    says format!(
        "the rotations miss gravity by {:.1}° rms beyond what the gyroscope's noise and knocks explain. The fastest rate is {:.0}°/s. Does the gyroscope \
         saturate, wrap or lose gain at such rates, are samples lost, or has it a g-sensitivity that is not estimated?",
        excess_sd_rad.to_degrees(),
        peak_radps.to_degrees()
    );

    /// The rotations meet gravity worse with the calibration than without it.
    RotationsWorse "rotations-worse" Warning {
        /// Rotation error with the calibration, root mean square, rad.
        after_rad: f64,
        /// Rotation error before it, rad.
        before_rad: f64,
    }
    decided "The rotation error grows by more than a half, and is larger than its noise by as much."
    remedy "Look at the rotations in the report, at spikes that were replaced, and at the sample times. Keep the sensor still in the holds."
    says format!(
        "the rotations miss gravity by {:.2}° rms with this calibration, but by {:.2}° without it. Something in holds or samples misleads it: look at the rotations in the \
         report, at spikes that were replaced, and at the sample times.",
        after_rad.to_degrees(),
        before_rad.to_degrees()
    );

    /// The rotations fit much better with a gain that depends on the rate.
    GainDependsOnRate "gain-depends-on-rate" Warning {
        /// Change of the gain at the fastest rate that makes the rotations fit: above 0, the gyroscope reads too little there.
        share: f64,
        /// The largest rate of a rotation, rad/s.
        peak_radps: f64,
        /// How far a gain would move, in its standard deviations.
        moved_sds: f64,
    }
    decided "A term of the rate's cube is as large by chance once in ten thousand times, and would move a gain by more than two of its standard deviations."
    remedy "Turn the sensor more slowly, or choose a larger range. The gains hold for rates like those of this recording only."
    says format!(
        "at its fastest rate, {:.0}°/s, the gyroscope reads {:.2} % too {}: the rotations fit much better with a gain that depends on the rate, and a gain would move by {:.1} \
         standard deviations",
        peak_radps.to_degrees(),
        100.0 * share.abs(),
        if *share > 0.0 { "little" } else { "much" },
        moved_sds
    );

    /// The mean rate of the gyroscope differs from hold to hold by far more than its noise explains.
    RestScatters "rest-scatters" Warning {
        /// Standard deviation between holds beyond noise, rad/s.
        between_sd_radps: f64,
        /// Is the g-sensitivity estimated?
        has_g_sensitivity: bool,
    }
    decided "The standard deviation between holds is more than 0.1°/s, and the bias has 50 times the standard deviation that noise gives it."
    remedy "Estimate the g-sensitivity (gyroscope.g_sensitivity). Let the sensor warm up, and hold it still."
    says format!(
        "the gyroscope's mean rate differs from hold to hold by {:.2}°/s rms, far beyond its noise, and its bias is known no better than that. {}",
        between_sd_radps.to_degrees(),
        match has_g_sensitivity {
            true => "Let the sensor warm up, and hold it still.",
            false => "Has it a g-sensitivity? It is not estimated (gyroscope.g_sensitivity). Otherwise let the sensor warm up, and hold it still.",
        }
    );

    /// A gain of the gyroscope is known no better than before the calibration.
    GainsUncertain "gains-uncertain" Warning {
        /// The largest relative standard deviation of a gain.
        relative_sd: f64,
        /// The part of it that is the sample rate's.
        rate_sd: f64,
    }
    decided "A gain has a standard deviation of more than 2 %: gyroscopes are delivered with 1 to 5 %."
    remedy "Record with sample times, or say how well the rate is known. Record more rotations, about all axes."
    says format!(
        "a gain of the gyroscope has a standard deviation of {:.1} %. {}",
        100.0 * relative_sd,
        match 2.0 * rate_sd > *relative_sd {
            true => "It is that of the sample rate, which was not measured: record with sample times, or say how well the rate is known \
                (option `rate_sd_ppm`, or rate_sd_ppm in [columns]).",
            false => "Record more rotations, about all axes.",
        }
    );

    /// All gains of the gyroscope are off by one factor.
    GyroscopeScaled "gyroscope-scaled" Warning {
        /// The factor.
        factor: f64,
    }
    decided "All three gains are more than 5 % off, and differ from each other by less than a third of that. Gains of one sensor are off by per cents, \
        each by its own."
    remedy "Check the sample rate, the range of the gyroscope (its sensitivity), and its unit."
    says format!(
        "the gyroscope reads {factor:.3} times the turns that gravity shows, on all three axes. Is the sample rate {factor:.3} times the one that was used, or was the \
         sensitivity of another range used, or another unit?"
    );

    /// A rotation is not used.
    RotationLeftOut "rotation-left-out" Warning {
        /// Number of the hold before it, from 1.
        from_hold: usize,
        /// Number of the hold after it, from 1.
        to_hold: usize,
        /// Begin, s.
        start_s: f64,
        /// End, s.
        end_s: f64,
        /// Rotation error, rad, where the rotation can be integrated.
        error_rad: Option<f64>,
        /// The rotation error in its expected standard deviations.
        deviations: Option<f64>,
        /// Why.
        reason: RotationReason,
    }
    decided "It cannot be integrated, or its rotation error has too many standard deviations."
    remedy "Look at the rotation in the report. Record with a larger range, without pauses."
    says format!(
        "the rotation from hold {from_hold} to hold {to_hold} ({start_s:.1} to {end_s:.1} s) is not used: {reason}"
    );

    /// Several consecutive rotations are not used. This is not by chance.
    RotationsLeftOutInARow "rotations-left-out-in-a-row" Warning {
        /// Their number.
        rotations: usize,
        /// Begin of the first, s.
        start_s: f64,
        /// End of the last, s.
        end_s: f64,
    }
    decided "So long a run of unused rotations is improbable, and no change of a sensor explains it."
    remedy "Check whether the gyroscope saturates there, or a sensor changes."
    says format!(
        "the {rotations} consecutive rotations from {start_s:.1} to {end_s:.1} s are not used. This is not by chance. Did \
         the gyroscope saturate there, or did a sensor change?"
    );
}
