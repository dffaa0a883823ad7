"""Prints a network file of 100 vertiports and 2,000 aircraft.

The vertiports are spread evenly over 45 x 45 miles, with 26 stands each; all else is as in networks/paper.toml, but for
demand that a fleet of this size can just about carry. From the root of the project:

    python3 benches/large_network.py > large.toml
"""

from pathlib import Path

paper = Path("networks/paper.toml").read_text()
head, _ = paper.split("[[vertiports]]", 1)
_, tail = paper.split("[[aircraft_types]]", 1)


def vertiport(at: int) -> str:
    # A low-discrepancy sequence: powers of the plastic number.
    x_mi, y_mi = (45 * (ratio * at % 1) for ratio in (0.754877666, 0.569840291))
    busy = str(at < 25).lower()
    return f'[[vertiports]]\nid = "V{at}"\nx_mi = {x_mi:.1f}\ny_mi = {y_mi:.1f}\nstands = 26\nbusy = {busy}\n\n'


changes = {
    'name = "paper"': 'name = "large"',
    "count = 40": "count = 2000",
    "peak = { mean = 100, sd = 10 }": "peak = { mean = 9, sd = 2 }",
    "busy_pairs = { mean = 50, sd = 10 }": "busy_pairs = { mean = 5, sd = 1 }",
    "otherwise = { mean = 30, sd = 5 }": "otherwise = { mean = 3, sd = 0.6 }",
}
text = head + "".join(vertiport(at) for at in range(100)) + "[[aircraft_types]]" + tail
for old, new in changes.items():
    assert old in text, old
    text = text.replace(old, new)
print(text, end="")
