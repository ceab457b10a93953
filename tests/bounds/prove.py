#!/usr/bin/env python3
"""usage: prove.py BOUNDS_H DOC SCRIPT.g ...: proves each script with the constants of bounds.h, and that it fails with the smaller ones it names.
With DOC (docs/bounds.md): every constant of bounds.h has a row in its table "How each is proven". See README.md here."""
import concurrent.futures
import re
import subprocess
import sys


def constants(path):
    """The values of all object-like macros, and the texts of those with arguments."""
    with open(path, encoding="utf-8") as f:
        text = re.sub(r"/\*.*?\*/", "", f.read(), flags=re.S)
    values, functions = {}, {}
    for name, arguments, body in re.findall(r"^#define (QN_[A-Z0-9_]+)(\([a-z, ]*\))? +(.+)$", text, flags=re.M):
        if name == "QN_BASE_BOUNDS_H":
            continue
        (functions if arguments else values)[name] = (arguments, body.strip()) if arguments else body.strip()
    number = re.compile(r"0x[0-9a-f.]+p[+-]?\d+f?", re.I)

    def value(body):
        body = number.sub(lambda m: repr(float.fromhex(m.group().rstrip("fF") if "p" in m.group().lower() else m.group())), body)
        body = re.sub(r"\bQN_[A-Z0-9_]+\b", lambda m: repr(value(values[m.group()])), body)
        return float(eval(body, {"__builtins__": {}}))

    def look_up(name):
        called = re.match(r"(\w+)\(([0-9,]+)\)$", name)
        if not called:
            return value(values[name])
        arguments, body = functions[called.group(1)]
        for argument, given in zip(arguments.strip("()").split(", "), called.group(2).split(",")):
            body = re.sub(rf"\b{argument}\b", given, body)
        return value(body)

    return set(values) | set(functions), look_up


def proven(script, look_up, name=None, factor=1.0):
    """Whether all problems of the script are proven, which lines of ---- part."""
    parts = [proven_one(part, look_up, name, factor) for part in re.split(r"^# -{4,}$", script, flags=re.M)]
    return all(ok for ok, _ in parts), "".join(said for _, said in parts)


def proven_one(script, look_up, name, factor):
    text = re.sub(r"@(QN_[A-Z0-9_]+(?:\([0-9,]+\))?)@", lambda m: (look_up(m.group(1)) * (factor if m.group(1) == name else 1)).hex(), script)
    try:
        done = subprocess.run(["gappa", "-Eprecision=256"], input=text, capture_output=True, text=True, timeout=100 if name is None else 4, check=False)
    except subprocess.TimeoutExpired:
        return False, "gappa found no proof in time"
    said = done.stdout + done.stderr
    if done.returncode and "not satisfied" not in said and "no contradiction" not in said:
        sys.exit(f"gappa cannot read it: {said}")
    return done.returncode == 0, said


def main():
    names, look_up = constants(sys.argv[1])
    wrong = 0
    with open(sys.argv[2], encoding="utf-8") as f:
        table = f.read().split("## How each is proven", 1)[-1]
    rows = set(re.findall(r"`(QN_[A-Z0-9_]+)", table))
    for name in sorted(names - rows):
        print(f"docs/bounds.md does not say how {name} is proven")
        wrong += 1
    for name in sorted(rows - names):
        print(f"docs/bounds.md speaks of {name}, which bounds.h does not define")
        wrong += 1
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = []
        for path in sys.argv[3:]:
            with open(path, encoding="utf-8") as f:
                script = f.read()
            jobs.append((path, None, None, pool.submit(proven, script, look_up)))
            for name, factor in re.findall(r"^# tight: (\S+) ([0-9.]+)$", script, flags=re.M):
                jobs.append((path, name, factor, pool.submit(proven, script, look_up, name, float(factor))))
    for path, name, factor, job in jobs:
        ok, said = job.result()
        if name is None:
            print(f"{path}: {'proven' if ok else 'NOT PROVEN'}" + ("" if ok else "\n" + said))
            wrong += not ok
        else:
            print(f"  with {factor} {name}: {'PROVEN TOO, so it is not tight' if ok else 'fails, as it should'}")
            wrong += ok
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
