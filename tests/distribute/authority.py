# SPDX-License-Identifier: AGPL-3.0-or-later
"""Certificates of a test's own making, in the test's folder."""
import subprocess

from farm import WORK


def openssl(*words):
    subprocess.run(["openssl", *words], cwd=WORK, check=True, capture_output=True)


def authority(name):
    """NAME.pem and NAME.key."""
    openssl("req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", name + ".key", "-out", name + ".pem", "-days", "2", "-subj", "/CN=" + name)


def certify(by, address):
    """server.pem and server.key, for the server at that address."""
    openssl("req", "-newkey", "rsa:2048", "-nodes", "-keyout", "server.key", "-out", "server.csr", "-subj", "/CN=server")
    with open(WORK + "/names", "w") as f:
        f.write("subjectAltName=IP:" + address + "\n")
    openssl("x509", "-req", "-in", "server.csr", "-CA", by + ".pem", "-CAkey", by + ".key", "-CAcreateserial", "-out", "server.pem", "-days", "2", "-extfile", "names")
