"""7: the Allan deviation."""

import matplotlib.pyplot as plt

import calibrant as cb

noise = cb.noise("night.csv", sensor="gyroscope")
print(noise.to_frame())
ax = noise.plot()
ax.set_title("at rest")
plt.savefig("allan.png")
