/* Correction of an IMU, raw to true; written by calibrant 0.1.0.
 *
 * frame: imucal's: that of the faces on which the device was put
 * accelerometer: readings in counts, corrected in m/s^2
 * gyroscope: readings in counts, corrected in rad/s
 *
 * Define CALIBRANT_REAL as float before including this for single precision.
 */
#ifndef CALIBRANT_IMU_H
#define CALIBRANT_IMU_H

#ifndef CALIBRANT_REAL
#define CALIBRANT_REAL double
#endif

/* Bias of the accelerometer, counts. */
static const CALIBRANT_REAL calibrant_accelerometer_bias[3] = { 112.1, -128.6, 83.3 };

/* Matrix of its correction, (m/s^2) per (counts). */
static const CALIBRANT_REAL calibrant_accelerometer_matrix[3][3] = {
    { 0.004804966102746971, 7.063718849438793e-5, 3.497150958124818e-5 },
    { -4.120946398739531e-5, 0.004777433373815964, -8.724079131416416e-6 },
    { -6.382937488229933e-5, -1.0495285930341018e-5, 0.004679430658806902 },
};

/* Specific force (m/s^2) of a reading of the accelerometer. */
static inline void calibrant_correct_accelerometer(const CALIBRANT_REAL raw[3], CALIBRANT_REAL force[3])
{
    CALIBRANT_REAL y[3];
    int i;
    for (i = 0; i < 3; i++)
        y[i] = raw[i] - calibrant_accelerometer_bias[i];
    for (i = 0; i < 3; i++)
        force[i] = calibrant_accelerometer_matrix[i][0] * y[0] + calibrant_accelerometer_matrix[i][1] * y[1]
                 + calibrant_accelerometer_matrix[i][2] * y[2];
}

/* Bias of the gyroscope, counts. */
static const CALIBRANT_REAL calibrant_gyroscope_bias[3] = { -9.8, -6.1, 1.0 };

/* Matrix of its correction, (rad/s) per (counts). */
static const CALIBRANT_REAL calibrant_gyroscope_matrix[3][3] = {
    { 0.0010363752517950772, 4.350690829735939e-7, 6.829152203308704e-6 },
    { 1.791228256935158e-7, 0.0010840432813638806, 2.9885016880534855e-6 },
    { -1.0055005676341627e-5, -8.243608597158111e-6, 0.0010668235616414085 },
};

/* What it shows of specific force, (counts) per (m/s^2). */
static const CALIBRANT_REAL calibrant_gyroscope_g_sensitivity[3][3] = {
    { 0.0064, -0.0075, -0.0005 },
    { 0.0071, 0.008, 0.0101 },
    { 0.0016, -0.0015, 0.0039 },
};

/* Angular rate (rad/s) of a reading of the gyroscope, at the corrected specific force (m/s^2; zeros where it is not known). */
static inline void calibrant_correct_gyroscope(const CALIBRANT_REAL raw[3], const CALIBRANT_REAL force[3],
                                               CALIBRANT_REAL rate[3])
{
    CALIBRANT_REAL y[3];
    int i;
    for (i = 0; i < 3; i++)
        y[i] = raw[i] - calibrant_gyroscope_bias[i]
             - (calibrant_gyroscope_g_sensitivity[i][0] * force[0] + calibrant_gyroscope_g_sensitivity[i][1] * force[1]
                + calibrant_gyroscope_g_sensitivity[i][2] * force[2]);
    for (i = 0; i < 3; i++)
        rate[i] = calibrant_gyroscope_matrix[i][0] * y[0] + calibrant_gyroscope_matrix[i][1] * y[1]
                + calibrant_gyroscope_matrix[i][2] * y[2];
}

#endif
