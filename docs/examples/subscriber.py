#!/usr/bin/env python3
"""The least a display unit does, in Python: newest panorama only, its age, NO IMAGE when none comes.

    lcm-gen -p bot_core_image_t.lcm bot_core_image_metadata_t.lcm    # makes the package bot_core
    ./subscriber.py 'udpm://239.255.76.67:7667?ttl=1&recv_buf_size=16777216' [PICTURES]

Needs LCM's Python module, `lcm`: part of LCM's sources, and in PyPI from 1.5 on; Debian 12 and Ubuntu 22.04 do not package it.
"""
import sys
import time

import lcm

import bot_core

URL = sys.argv[1] if len(sys.argv) > 1 else "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=16777216"
WANTED = int(sys.argv[2]) if len(sys.argv) > 2 else 0
pictures = 0


def on_image(_channel, data):
    global pictures
    image = bot_core.image_t.decode(data)
    # Capture time against this clock: keep both set by NTP or PTP.
    age_ms = time.time() * 1e3 - image.utime / 1e3
    if age_ms > 500:
        print(f"NO IMAGE: the picture is {age_ms:.0f} ms old", flush=True)
        return
    properties = "  ".join(f"{p.key} {bytes(p.value).decode()}" for p in image.metadata)
    print(f"{properties}  {image.width}x{image.height} age {age_ms:.1f} ms", flush=True)
    with open("newest.jpg", "wb") as file:
        file.write(bytes(image.data))
    pictures += 1


network = lcm.LCM(URL)
network.subscribe("PANORAMA", on_image).set_queue_capacity(1)  # or pictures queue up and grow old
while WANTED == 0 or pictures < WANTED:
    if network.handle_timeout(500) == 0:
        print("NO IMAGE: none came", flush=True)
