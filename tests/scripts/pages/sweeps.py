# SPDX-License-Identifier: Apache-2.0
"""Files of results like those of `handcast sweep`."""


def write_sweep(folder, plan, columns, rows):
    """Writes a file of results. `rows` have no index."""
    file = folder / f"{plan}.csv"
    lines = [f"# handcast sweep version=0.1.0 fingerprint=0123 runs={len(rows)} plan={plan}", f"index,variant,{columns},error",
             *(f"{i},{row}" for i, row in enumerate(rows))]
    file.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    return file


def write_ladder(folder):
    """Rungs at two speeds: the error falls with the cost. The paper is slow and has a medium error."""
    rows = []
    for speed in (1, 3):
        rows += [f"paper,builtin:wave,{speed},8.9,2,{4.0 * speed},1900,",
                 f"hold,builtin:wave,{speed},6.1,7,{14.0 * speed},700,",
                 f"shift,builtin:wave,{speed},6.3,3,{5.0 * speed},760,",
                 f"handcast,builtin:wave,{speed},6.8,1,{2.1 * speed},1000,"]
    columns = "twin.motion,twin.speed,motion_to_photon_ms,interior_mm_mean,interior_mm_p95,frame_us_p50"
    return write_sweep(folder, "ladder", columns, rows)


def write_stress(folder):
    """Two methods with tracker samples of increasing age: the error of the paper doubles at 15 ms, that of handcast never."""
    return write_sweep(folder, "stress", "twin.tracker.age_ms,twin.seed,interior_mm_mean",
                       ["paper,5,1,2,", "paper,5,2,4,", "paper,10,1,5,", "paper,20,1,7,",
                        "handcast,5,1,1,", "handcast,10,1,1.1,", "handcast,20,1,1.9,"])


def write_failures(folder):
    """A passing fault, a lasting one, and a difficult motion."""
    return write_sweep(folder, "failures",
                       "twin.tracker.lost_at_s,twin.tracker.lost_s,twin.motion,twin.image.dark,interior_mm_p95,coverage,spill,foldovers,"
                       "fault_worst_mm,fault_dark_ms,fault_recovery_ms",
                       ["paper,1,0.2,builtin:wave,,4,0.9,0.1,0,60,20,73,",
                        "handcast,1,0.2,builtin:wave,,3,0.9,0.1,0,30,10,,",
                        "handcast,,,builtin:wave,0.5,2.5,0.8,0.01,0,,,,",
                        "handcast,,,builtin:cross_fingers,,2.2,0.99,0.01,0,,,,"])


def write_hardware(folder):
    """Two cameras with two projectors. The slower projector costs 3 mm, the slower camera 1 mm, the paper's method 4 mm; two seeds
    differ by 1 mm."""
    rows = []
    for method, method_mm in (("handcast", 0), ("paper", 4)):
        for camera, camera_mm in ((60, 1), (525, 0)):
            for projector, projector_mm in (("946,3", 0), ("60,50", 3)):
                for speed in (1, 3):
                    rows += [f"{method}_{camera},{projector},builtin:coin,{speed},{seed},{4 + seed + method_mm + camera_mm + projector_mm},"
                             f"12,0.1,-0.5,{60 - camera / 10:g}," for seed in (1, 2)]
    columns = ("projector.rate_hz,projector.latency_ms,twin.motion,twin.speed,twin.seed,interior_mm_mean,interior_mm_p95,off_10mm,"
               "equivalent_latency_ms,motion_to_photon_ms")
    return write_sweep(folder, "hardware", columns, rows)


def write_all(folder):
    """The files of all charts."""
    return [write_ladder(folder), write_stress(folder), write_failures(folder), write_hardware(folder)]
