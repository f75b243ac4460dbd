"""5: a design, and its plot."""

import matplotlib.pyplot as plt

import calibrant as cb

stage = cb.Experiment.preset("stage", limits={"velocity_mps": 0.4, "displacement_m": 0.25})
best = cb.design(stage, gap=0.1, progress=lambda done, total, text: None)  # Ctrl-C: the best so far
print(best.summary(), best.gap, best.interrupted)
best.plot()
plt.savefig("best.png")
assert best.motion is not None
best.motion.save("motion.csv", rate_hz=500)
print(cb.design_poses(cb.Experiment.preset("static-poses"), 12).to_frame())
