"""How a sweep scales on Ray's local cluster of 2 CPUs, against one process with one thread.

Three times each in turn, after one sweep that starts the workers; both have the same results.
"""

import statistics
import time

import ray
import vertifleet
import vertifleet.ray

CPUS = 2
CHANGES = {"fleet.0.count": [32, 34, 36, 38, 40], "vertiports.*.stands": [6, 7]}
POLICIES = ["prices", "gcaps-x"]


def seconds(call):
    begun = time.perf_counter()
    found = call()
    return time.perf_counter() - begun, found


def main():
    ray.init(num_cpus=CPUS, include_dashboard=False, log_to_driver=False)
    network = vertifleet.Network("paper")
    vertifleet.ray.sweep(network, {"fleet.0.count": [40]}, ["gcaps-x"], days=4)
    scalings = []
    for _ in range(3):
        alone_s, alone = seconds(lambda: vertifleet.sweep(network, CHANGES, POLICIES, days=40, threads=1))
        cluster_s, cluster = seconds(lambda: vertifleet.ray.sweep(network, CHANGES, POLICIES, days=40))
        assert (alone.columns["profit_usd"] == cluster.columns["profit_usd"]).all()
        scalings.append(alone_s / cluster_s / CPUS)
        print(f"{alone_s:.1f} s, {cluster_s:.1f} s, scaling {scalings[-1]:.2f}", flush=True)
    print(f"median {statistics.median(scalings):.2f}")


main()
