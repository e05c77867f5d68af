"""Projects points with a cameramodel by mrcal: FILE.cameramodel POINTS PIXELS.

POINTS: x y z in the frame of reference, one a line; PIXELS gets u v, one a line.
"""
import sys

import mrcal
import numpy as np

model = mrcal.cameramodel(sys.argv[1])
points = np.loadtxt(sys.argv[2], ndmin=2)
pixels = mrcal.project(mrcal.transform_point_rt(model.extrinsics_rt_fromref(), points),
                       *model.intrinsics())
np.savetxt(sys.argv[3], pixels, fmt="%.17g")
