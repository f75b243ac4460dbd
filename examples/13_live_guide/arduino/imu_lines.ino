// An MPU-6050 on I²C, for Arduino and ESP32: prints what `calibrant guide` reads. Raw counts need no library: the ranges are ±2 g and ±250 °/s.
#include <Wire.h>

const int ADDRESS = 0x68;

void setup() {
  Serial.begin(115200);
  Wire.begin();
  Wire.setClock(400000);
  Wire.beginTransmission(ADDRESS); Wire.write(0x6B); Wire.write(0x01); Wire.endTransmission();  // awake, clock of the gyroscope
  Wire.beginTransmission(ADDRESS); Wire.write(0x1B); Wire.write(0x00); Wire.write(0x00); Wire.endTransmission();  // ranges: ±250 °/s, ±2 g
  Wire.beginTransmission(ADDRESS); Wire.write(0x1A); Wire.write(0x03); Wire.endTransmission();  // low-pass at 44 Hz
}

void loop() {
  static unsigned long next_us = micros(), lines = 0;
  while ((long)(micros() - next_us) < 0) {}
  next_us += 10000;  // 100 Hz
  if (lines++ % 500 == 0) Serial.println("t_us,ax,ay,az,gx,gy,gz,temp_c");  // whoever listens later knows the columns, too
  unsigned long t_us = micros();
  Wire.beginTransmission(ADDRESS); Wire.write(0x3B); Wire.endTransmission(false);
  if (Wire.requestFrom(ADDRESS, 14) != 14) return;
  int16_t v[7];
  for (int k = 0; k < 7; k++) { int high = Wire.read(); v[k] = (high << 8) | Wire.read(); }
  Serial.print(t_us);
  for (int k = 0; k < 7; k++) if (k != 3) { Serial.print(','); Serial.print(v[k]); }
  Serial.print(','); Serial.println(v[3] / 340.0 + 36.53, 2);
}
