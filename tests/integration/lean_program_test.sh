#!/usr/bin/env bash
# The program on the road loads no library for videos, pictures, windows, HTTP or calibration: they would be locked into its memory, and
# read from the disk before its first panorama.
#
#   tests/integration/lean_program_test.sh PROGRAM
set -euo pipefail
loaded=$(ldd "$1")
echo "$(wc --lines <<<"$loaded") libraries"
grep --quiet libopencv_core <<<"$loaded" || { echo "FAILED: ldd does not tell what $1 loads" && exit 1; }
! grep --extended-regexp 'opencv_(videoio|imgcodecs|highgui|calib3d|features2d)|avcodec|gstreamer|gdal|ceres|microhttpd|cairo' <<<"$loaded" ||
    { echo "FAILED: loads what the road does not need" && exit 1; }
