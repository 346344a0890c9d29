"""Agents waiting in line for one worker, from service times that were measured.

Every agent brings a segment each period; the worker serves them in the order of arrival, so that
the time from arrival to completion is the wait for those before and the service itself.  Only the
waiting is computed: service times are drawn from those that a worker took with as many agents'
memory to go through, one segment after the other.
"""

import numpy as np

ROUNDS = 12  # periods after the first, in which the line forms
DRAWS = 30  # times that the agents' moments are drawn anew


def completions(service, agents, period, spread, seed=1):
    """Seconds from arrival to completion; `spread`: evenly in time, or at random moments."""
    random = np.random.default_rng(seed)
    service = np.asarray(service)
    result = []
    for _ in range(DRAWS):
        phases = (np.arange(agents) * period / agents if spread
                  else np.sort(random.uniform(0, period, agents)))
        arrivals = (phases + period * np.arange(ROUNDS + 1)[:, None]).ravel()
        taken = random.choice(service, arrivals.size)
        result.append(_wait(arrivals, taken)[agents:])
    return np.concatenate(result)


def _wait(arrivals, taken):
    """A worker is busy until max(arrival, end before) + service: a running maximum."""
    total = np.cumsum(taken)
    ends = total + np.maximum.accumulate(arrivals - (total - taken))
    return ends - arrivals


def most_agents(service, period, deadline, spread, quantile=0.999):
    """The largest number whose `quantile` of completions meets the deadline."""
    def meets(agents):
        return np.quantile(completions(service, agents, period, spread), quantile) <= deadline

    low, high = 0, int(period / np.mean(service)) + 2
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if meets(middle) else (low, middle)
    return low
