(()=>{var e=()=>new Promise(t=>requestAnimationFrame(()=>setTimeout(t)));window.fpcadPainted=e();})();
