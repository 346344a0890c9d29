"""What the machine and the programs on it call themselves."""

import json
import os
import pathlib
import platform
import re
import subprocess
import time


def describe():
    """One line: processor, its cores and caches, kernel."""
    fields = {}
    for entry in json.loads(_output("lscpu", "--json") or '{"lscpu": []}')["lscpu"]:
        _collect(entry, fields)
    parts = [f"{fields.get('Vendor ID:', '')} {fields.get('Model name:', platform.machine())}".strip()
             + f" (family {fields.get('CPU family:', '?')}, model {fields.get('Model:', '?')})",
             f"{len(os.sched_getaffinity(0))} CPUs"]
    parts += [f"{name} {fields[name + ' cache:']}" for name in ("L1d", "L2", "L3")
              if name + " cache:" in fields]
    if "Hypervisor vendor:" in fields:
        parts.append(f"a virtual machine ({fields['Hypervisor vendor:']})")
    return ", ".join(parts + [f"Linux {platform.release()}"])


def _collect(entry, fields):
    fields[entry["field"]] = entry["data"]
    for child in entry.get("children", ()):
        _collect(child, fields)


def versions(root, node_modules):
    """engine name -> version; gestus' is the commit of the tree at `root`."""
    found = {"gestus": _output("git", "-C", root, "describe", "--always", "--dirty") or "unknown",
             "torch": _output("dpkg-query", "-W", "-f=${Version}", "python3-torch") or "unknown"}
    package = node_modules / "onnxruntime-node" / "package.json"
    if package.exists():
        node = _output("node", "--version") or "unknown"
        found["ort"] = f"{json.loads(package.read_text())['version']} (Node {node.lstrip('v')})"
    compiler = _output("c++", "--version")
    if compiler:
        found["gestus"] += f" (g++ {re.search(r'[0-9.]+$', compiler.splitlines()[0])[0]})"
    return found


def busy_share(seconds=0.5):
    """Share of all CPUs' time that others take while this program sleeps."""
    before = _cpu_times()
    time.sleep(seconds)
    spent = [after - x for after, x in zip(_cpu_times(), before)]
    idle = spent[3] + spent[4]  # and waiting for a disk
    return 1 - idle / max(1, sum(spent))


def _cpu_times():
    """user, nice, system, idle, iowait, irq, softirq, steal."""
    return [int(x) for x in pathlib.Path("/proc/stat").read_text().split("\n")[0].split()[1:9]]


def _output(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""
