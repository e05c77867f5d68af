"""Root mean squared distance of the corners in a solution of mrcal: FILE.cameramodel, px."""
import sys

import mrcal
import numpy as np

inputs = mrcal.cameramodel(sys.argv[1]).optimization_inputs()
count = mrcal.num_measurements_boards(**inputs)
residuals = mrcal.optimizer_callback(**inputs)[1][:count]
print(np.sqrt(np.sum(residuals**2) / (count / 2)))
