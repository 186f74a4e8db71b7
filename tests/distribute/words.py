# SPDX-License-Identifier: AGPL-3.0-or-later
"""POV-Ray's words: what the farm makes of INI files and switches is what POV-Ray itself writes down with Create_Ini, given the same words."""
import os
import random
import subprocess

from farm import BIN, ENV, PATIENCE, WORK, Server, bhfarm, include_folder, patiently, scene

folder = WORK + "/scene"
scene(folder)
server = Server()
random.seed(1)
SWITCHES = ["+A", "-A", "+A0.2", "+AM2", "+AM1", "+R2", "+J0.5", "-J", "+Q5", "+W48", "+H40", "+KI0.25", "+KF0.75", "+KFF5", "+KFI2", "+KC", "-KC", "+SF3", "+EF4",
            "+MB5", "-MB", "+BM2", "+UV", "-UR", "+SU", "+FN", "+FN16", "+FE", "+WL3", "+UA", "+BS16", "+HR", "+AG2.0"]
KEYS = ["Antialias=on", "antialias_depth=4", "Antialias_Threshold = 0.1", "Quality=7 ; less", "Final_Frame=6", "Initial_Clock=0.125", "Clock=3",
        "Bounding=off", "Jitter_Amount=0.3", "Frame_Step=2", "Subset_Start_Frame=2", "Declare=Foo=3", "Declare=Bar=0.5", "Sampling_Method=2", "Width=64",
        "Height=32", "Bits_Per_Color=16", "Output_Alpha=on", "Split_Unions=on", "Bounding_Threshold=9"]
# Their own business: POV-Ray's names for what the farm keeps elsewhere, and what it says itself.
ELSEWHERE = {"Width", "Height", "Bits_Per_Color", "Output_File_Type", "Subset_Start_Frame", "Subset_End_Frame", "Frame_Step", "Library_Path", "Input_File_Name",
             "Output_To_File", "Output_File_Name", "Display", "Work_Threads", "Create_Ini", "Dither", "Reproducible", "Verbose", "Start_Row", "Continue_Trace", "Warning_File"}


def settings(text):
    found = {}
    for line in text.splitlines():
        key, _, value = line.partition("=")
        key = key.strip()
        value = value.strip().strip('"')
        if key == "Declare":
            found["Declare " + value.partition("=")[0]] = float(value.partition("=")[2])
        elif key:
            key = key.title()
            try:
                found[key] = float(value)
            except ValueError:
                found[key] = {"on": 1.0, "off": 0.0}.get(value.lower(), value)
    return found


tried = 0
for round_ in range(40):
    lines = random.sample(KEYS, 5) + random.sample(SWITCHES, 3)
    random.shuffle(lines)
    words = random.sample(SWITCHES, 4)
    with open(folder + "/odd.ini", "w") as f:
        f.write("Input_File_Name=film.pov\nInitial_Frame=1\nFinal_Frame=4\nWidth=32\nHeight=32\n" + "\n".join(lines) + "\n[Other]\nWidth=999\n")
    with open(WORK + "/none.ini", "w") as f:
        f.write("Verbose=Off\n")
    written = folder + "/written.ini"
    asked = [BIN + "/povray", "odd.ini", *words, "+GIwritten.ini", "-D", "-F", "+L" + include_folder(), "+SR1000"]
    patiently(lambda: subprocess.run(asked, cwd=folder, capture_output=True, text=True, errors="replace", timeout=PATIENCE, env=dict(ENV, POVINI=WORK + "/none.ini")),
              lambda run: run.stderr)
    theirs = settings(open(written).read())
    os.remove(written)
    done = bhfarm("submit", "odd.ini", *words, "--video", "none", server=server, cwd=folder, good=False)
    if done.returncode:
        assert len(done.stderr.strip().split("\n")) == 1, done.stderr
        continue # what the farm does not take, such as a last frame below the first
    spec = server.job(int(done.stdout))["spec"]
    ours = settings("\n".join(spec["options"]))
    tried += 1
    for key in set(ours) | set(theirs):
        if key in ELSEWHERE or key.startswith("Declare clock") or key == "Output_To_File":
            continue
        if key in theirs:
            assert ours.get(key) == theirs[key], (key, ours.get(key), theirs[key], lines, words)
    for key, name in (("Width", "width"), ("Height", "height")):
        assert spec[name] == theirs[key], (key, spec[name], theirs[key], lines, words)
    # POV-Ray's own rule for frames (its source, animationprocessing.cpp): from Subset_Start_Frame or the first to Subset_End_Frame or the last
    assert spec["first"] == max(theirs.get("Subset_Start_Frame", theirs["Initial_Frame"]), theirs["Initial_Frame"]), (spec, theirs)
    assert spec["last"] == theirs.get("Subset_End_Frame", theirs["Final_Frame"]), (spec, theirs)
    assert spec["step"] == theirs.get("Frame_Step", 1)
assert tried >= 15, tried
print("%d sets of words, read as POV-Ray reads them" % tried)
