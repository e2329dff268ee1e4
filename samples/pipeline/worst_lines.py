#!/usr/bin/env python3
"""Reads the document of --json and prints the lines with the largest deviations: counterflex ... --json | worst_lines.py"""
import json
import sys

report = json.load(sys.stdin)
before, after = report["summary"]["before"], report["summary"]["after"]
print(f"{report['inputs']['program']['path']}: {before['max_mm']:.3f} mm before, {after['max_mm']:.4f} mm after")
for row in report["worst"][:3]:
    print(f"  line {row['line']}: {row['before_mm']:.3f} mm before, {row['after_mm']:.4f} mm after")
