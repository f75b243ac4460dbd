# An MPU-6050 on I²C, for MicroPython: prints what `calibrant guide` reads.
from machine import I2C, Pin
from struct import unpack
from time import sleep_ms, ticks_us

i2c = I2C(0, scl=Pin(22), sda=Pin(21), freq=400_000)
i2c.writeto_mem(0x68, 0x6B, b"\x01")  # awake, clock of the gyroscope
i2c.writeto_mem(0x68, 0x1B, b"\x00\x00")  # ranges: ±250 °/s, ±2 g
i2c.writeto_mem(0x68, 0x1A, b"\x03")  # low-pass at 44 Hz
lines = 0
while True:
    if lines % 500 == 0:  # whoever listens later knows the columns, too
        print("t_us,ax,ay,az,gx,gy,gz,temp_c")
    lines += 1
    t_us = ticks_us()
    ax, ay, az, t, gx, gy, gz = unpack(">7h", i2c.readfrom_mem(0x68, 0x3B, 14))
    print(t_us, ax, ay, az, gx, gy, gz, t / 340 + 36.53, sep=",")
    sleep_ms(9)
