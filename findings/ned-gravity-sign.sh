#!/bin/sh
# AHRS 0.4.0 and imufusion 1.3.3 want opposite signs from an accelerometer in north-east-down.
# At rest an accelerometer measures the force of the table: with z down it reads (0, 0, -g). imufusion with CONVENTION_NED agrees. AHRS wants (0, 0, +g): its
# EKF with frame="NED" takes the right reading as a sensor that is upside down, and "ENU" gives the same attitude as "NED". So one recording, z down and
# rolled by 10 degrees, comes out level by the one and upside down by the other. Neither says anything.
# Seen, roll in degrees:
#     reading of an accelerometer (0, -g sin 10, -g cos 10): imufusion NED 10.0, AHRS NED -170.0, AHRS ENU -170.0
#     the same with the other sign:                          AHRS NED 10.0, AHRS ENU 10.0
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${PYTHON:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet ahrs==0.4.0 imufusion==1.3.3 numpy==2.4.6
"$folder/venv/bin/python" - <<'END'
import ahrs
import imufusion
import numpy as np

ROLL, ROWS = np.radians(10.0), 4000
reading = np.array([0.0, -np.sin(ROLL), -np.cos(ROLL)])


def roll(w, x, y, z):
    return round(float(np.degrees(np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)))), 1)


def by_imufusion(reading):
    filter_ = imufusion.Ahrs()
    settings = imufusion.AhrsSettings()
    settings.convention = imufusion.CONVENTION_NED
    settings.sample_rate = 100.0
    filter_.set_settings(settings)
    for _ in range(ROWS):
        filter_.update_no_magnetometer(np.zeros(3), reading)
    return roll(*filter_.get_quaternion())


def by_ahrs(reading, frame):
    rows = np.tile(9.81 * reading, (ROWS, 1))
    return roll(*ahrs.filters.EKF(gyr=0 * rows, acc=rows, frequency=100.0, frame=frame).Q[-1])


seen = [by_imufusion(reading), by_ahrs(reading, "NED"), by_ahrs(reading, "ENU"), by_ahrs(-reading, "NED"), by_ahrs(-reading, "ENU")]
print("reading of an accelerometer (0, -g sin 10, -g cos 10): imufusion NED {}, AHRS NED {}, AHRS ENU {}".format(*seen[:3]))
print("the same with the other sign:                          AHRS NED {}, AHRS ENU {}".format(*seen[3:]))
assert seen == [10.0, -170.0, -170.0, 10.0, 10.0]
END
